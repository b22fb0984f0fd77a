#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <vector>

namespace emap {

constexpr std::uint32_t kNoPatch = std::numeric_limits<std::uint32_t>::max();

// Seeds, planes and assignment of a partition that may leave elements out.
struct RoughPartition {
  std::vector<std::uint32_t> patch_of;   // kNoPatch where no patch could take an element
  std::vector<Eigen::Vector3d> normals;  // of the patches' planes
  std::vector<std::uint32_t> seeds;      // one element of each patch
};

}  // namespace emap
