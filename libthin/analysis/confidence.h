#pragma once

// Means of repeated measurements, with how far they can be trusted.

#include <span>

namespace thin {

struct MeanWithInterval {
  double mean = 0;
  double half_width = 0;  // of the 95 % interval by Student's t; 0 for fewer than two measurements
};

// REQUIRES: not empty. Measurements are taken for independent: where they are not, the interval is too narrow.
MeanWithInterval mean_with_interval(std::span<const double> measurements);

// The 0.975 quantile of Student's t. REQUIRES: degrees_of_freedom >= 1
double student_t_975(std::size_t degrees_of_freedom);

}  // namespace thin
