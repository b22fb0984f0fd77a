#pragma once

// Repeated measurements as a table shows them.

#include <string>
#include <vector>

namespace thin {

// "0.8712 +- 0.0041": mean and half width of the 95 % interval, both times `scale`; numbers that are not finite are
// left out, and "-" is where none is left.
std::string with_interval(const std::vector<double>& numbers, double scale, int decimals);

}  // namespace thin
