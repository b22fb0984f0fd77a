#include "libthin/tools/interval_text.h"

#include <fmt/format.h>

#include <cmath>

#include "libthin/analysis/confidence.h"

namespace thin {

std::string with_interval(const std::vector<double>& numbers, double scale, int decimals) {
  std::vector<double> finite;
  for (const double number : numbers)
    if (std::isfinite(number)) finite.push_back(scale * number);
  if (finite.empty()) return "-";
  const MeanWithInterval mean = mean_with_interval(finite);
  return fmt::format("{:.{}f} +- {:.{}f}", mean.mean, decimals, mean.half_width, decimals);
}

}  // namespace thin
