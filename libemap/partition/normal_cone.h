#pragma once

// The narrowest cone of directions around given unit normals, by their smallest enclosing ball (thesis, 3.3.1).

#include <Eigen/Geometry>
#include <vector>

namespace emap {

struct NormalCone {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // of unit length
  double aperture_cosine = 1;                       // of the widest angle to the axis; equation 3.3
};

// Zero vectors are passed over. Without normals, or where their ball is centred at the origin (they point all ways),
// the axis is the z-axis. Expected O(n).
NormalCone normal_cone(const std::vector<Eigen::Vector3d>& normals);

}  // namespace emap
