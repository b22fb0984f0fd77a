#include "libemap/partition/partition.h"

namespace emap {

double Partition::mean_distortion() const {
  double distortion = 0, area = 0;
  for (const Patch& patch : patches) {
    distortion += patch.distortion;
    area += patch.area;
  }
  return area > 0 ? distortion / area : 0;
}

std::vector<std::vector<std::uint32_t>> Partition::elements_of_patches() const {
  std::vector<std::vector<std::uint32_t>> elements(patches.size());
  for (std::size_t patch = 0; patch < patches.size(); ++patch) elements[patch].reserve(patches[patch].element_count);
  for (std::uint32_t element = 0; element < patch_of.size(); ++element) elements[patch_of[element]].push_back(element);
  return elements;
}

}  // namespace emap
