#pragma once

// The analysis and its covariance as whole matrices, and J by its definition: every step by doing it and looking.

#include <cmath>
#include <cstdint>
#include <vector>

#include "libthin/estimation/places.h"

namespace thin::test {

struct LocalAnalysisOracle {
  std::size_t n = 0, channels = 1;
  std::vector<std::uint32_t> points;  // indices of observations
  std::vector<double> values, targets;
  double error_ratio = 0.4, coverage = 0;
  std::vector<std::vector<bool>> is_near;
  std::vector<std::vector<double>> covariance;
  std::vector<std::vector<double>> analysis;  // n x channels
  std::vector<bool> retained;

  LocalAnalysisOracle(const Places& places, const std::vector<double>& all_values, std::size_t channel_count,
                      double length_km, bool two_scales)
      : n(places.size()), channels(channel_count), values(all_values) {
    const double reach_km = two_scales ? 4 * length_km : 3 * length_km;
    is_near.assign(n, std::vector<bool>(n));
    covariance.assign(n, std::vector<double>(n, 0.0));
    analysis.assign(n, std::vector<double>(channels, 0.0));
    retained.assign(n, false);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        double squared = 0;
        for (std::size_t axis = 0; axis < places.of(i).size(); ++axis)
          squared += std::pow(places.of(i)[axis] - places.of(j)[axis], 2);
        const auto gaussian = [&](double length) { return std::exp(-squared / (2 * length * length)); };
        is_near[i][j] = squared <= reach_km * reach_km && places.group_of(i) == places.group_of(j);
        if (is_near[i][j])
          covariance[i][j] =
              two_scales ? (gaussian(length_km * 2 / 3) + gaussian(length_km * 4 / 3)) / 2 : gaussian(length_km);
      }
  }

  double j() const {
    double sum = 0;
    for (std::size_t q = 0; q < points.size(); ++q) {
      for (std::size_t c = 0; c < channels; ++c) sum += std::pow(targets[q * channels + c] - analysis[points[q]][c], 2);
      sum += coverage * covariance[points[q]][points[q]];
    }
    return sum;
  }

  void change_state(std::size_t p) {
    const double sign = retained[p] ? -1 : 1;
    const double k = 1 / (covariance[p][p] + sign * error_ratio * error_ratio);
    const std::vector<double> column = covariance[p];
    std::vector<double> departure;
    for (std::size_t c = 0; c < channels; ++c) departure.push_back(values[p * channels + c] - analysis[p][c]);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < channels; ++c) analysis[i][c] += k * departure[c] * column[i];
      for (std::size_t m = 0; m < n; ++m)
        if (is_near[i][m]) covariance[i][m] -= k * column[i] * column[m];
    }
    retained[p] = !retained[p];
  }

  // What changing each observation's state would add to J.
  std::vector<double> increments() const {
    std::vector<double> result;
    for (std::size_t p = 0; p < n; ++p) {
      LocalAnalysisOracle changed = *this;
      changed.change_state(p);
      result.push_back(changed.j() - j());
    }
    return result;
  }
};

}  // namespace thin::test
