#include "libemap/coding/elevation_coder.h"

#include <algorithm>
#include <array>

#include "libemap/coding/baseline_coder.h"
#include "libemap/coding/contexts_coder.h"

namespace emap {
namespace {

template <class Predicate>
const ElevationCoder* find(const Predicate& predicate) {
  const std::span<const ElevationCoder> all = elevation_coders();
  const auto found = std::find_if(all.begin(), all.end(), predicate);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

std::span<const ElevationCoder> elevation_coders() {
  static const std::array coders = {contexts_coder(), baseline_coder()};
  return coders;
}

const ElevationCoder* find_elevation_coder(std::uint8_t number) {
  return find([&](const ElevationCoder& coder) { return coder.number == number; });
}

const ElevationCoder* find_elevation_coder(const std::string& name) {
  return find([&](const ElevationCoder& coder) { return coder.name == name; });
}

}  // namespace emap
