#include "libthin/thinning/retain_target.h"

#include <algorithm>
#include <cmath>

namespace thin {

void RetainTarget::declare_options(OptionTable& table) {
  table.add("retain_count", retain_count,
            {.unit = "observations", .minimum = 0, .explanation = "how many to retain; all, where there are fewer"});
  table.add("retain_fraction", retain_fraction,
            {.minimum = 0, .maximum = 1, .explanation = "share to retain of the observations left after screening"});
}

std::optional<ThinningMethod::Conflict> RetainTarget::conflict() const {
  if (retain_count && retain_fraction)
    return ThinningMethod::Conflict{"retain_fraction", "is set beside retain_count: give one of the two"};
  if (!retain_count && !retain_fraction)
    return ThinningMethod::Conflict{"retain_fraction",
                                    "is missing: say how many to keep by retain_fraction (0.1) or retain_count (3000)"};
  return std::nullopt;
}

std::size_t RetainTarget::count_of(std::size_t n) const {
  if (retain_count) return std::min(n, static_cast<std::size_t>(*retain_count));
  const double wanted = retain_fraction.value_or(1.0) * static_cast<double>(n);
  const bool some = n > 0 && wanted > 0;
  return std::min(n, std::max<std::size_t>(some ? 1 : 0, static_cast<std::size_t>(std::llround(wanted))));
}

}  // namespace thin
