#pragma once

// A surface cut into patches, each of which is a height field over a plane (thesis, 3.3.2). The elements that are
// shared out are the triangles of a mesh or the points of a point set.

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace emap {

struct Patch {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of the base plane: the patch is a height field along it
  double aperture_cosine = 1;                         // A of equation 3.3: cosine of the widest angle to `normal`
  double area = 0;
  double distortion = 0;  // J(S) of equation 3.4: the integral of |n - normal|² over the patch
  std::uint32_t element_count = 0;
};

struct Partition {
  std::vector<std::uint32_t> patch_of;  // one for each element: its index in `patches`
  std::vector<Patch> patches;           // none of them empty

  // J of equation 3.4 divided by the area, as the thesis's table 3.2 states it.
  double mean_distortion() const;

  // The elements of each patch, ascending.
  std::vector<std::vector<std::uint32_t>> elements_of_patches() const;
};

}  // namespace emap
