#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "libthin/thinning/box.h"
#include "libthin/thinning/grid_eea.h"
#include "libthin/thinning/stepwise.h"
#include "libthin/thinning/thinning_method.h"

namespace thin {
namespace {

template <class Method>
std::unique_ptr<ThinningMethod> make() {
  return std::make_unique<Method>();
}

}  // namespace

std::span<const MethodEntry> thinning_methods() {
  static const std::array entries = {
      MethodEntry{"box", "one observation per equal-area box, the nearest to its centre",
                  "Purser et al. 2000; box thinning as centres use it", make<Box>},
      MethodEntry{"grid_eea", "greedy removal of what the Gaussian estimate on the GME grid misses least",
                  "estimation error analysis on a regular grid: thesis 6.3.3, eq. 6.10-6.14", make<GridEea>},
      MethodEntry{"stepwise", "every s-th field of view of every s-th scan line", "the reference of thesis 6.5",
                  make<Stepwise>},
  };
  return entries;
}

const MethodEntry* find_thinning_method(const std::string& name) {
  const auto entries = thinning_methods();
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const MethodEntry& e) { return e.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

Result<void> require_finite_values(const ObservationSet& observations) {
  for (std::size_t i = 0; i < observations.values.size(); ++i)
    if (!std::isfinite(observations.values[i])) {
      const std::size_t channels = observations.channel_count();
      return Error{ErrorKind::input,
                   fmt::format("observation {} has no usable value in channel {}; screen it out before thinning "
                               "([preparation] channels, or leave the channel out)",
                               i / channels, observations.channels[i % channels])};
    }
  return {};
}

}  // namespace thin
