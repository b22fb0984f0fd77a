#pragma once

// The estimation error analysis with nothing clever in it: every sum from its definition, every step by trying all.

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin::test {

struct EstimationOracle {
  std::vector<Vector3> evaluation_points;
  std::vector<Vector3> positions;
  std::vector<double> values;  // n x channels
  std::size_t channels = 1;
  double bandwidth_km = 100;

  // est_P(x); zeros where nothing of P is within 3h.
  std::vector<double> estimate(const Vector3& x, const std::vector<bool>& retained) const {
    std::vector<double> sum(channels, 0.0);
    double weights = 0;
    for (std::size_t p = 0; p < positions.size(); ++p) {
      if (!retained[p]) continue;
      const double dx = x.x - positions[p].x, dy = x.y - positions[p].y, dz = x.z - positions[p].z;
      const double squared = dx * dx + dy * dy + dz * dz;
      if (squared > 9 * bandwidth_km * bandwidth_km) continue;
      const double weight = std::exp(-squared / (bandwidth_km * bandwidth_km));
      weights += weight;
      for (std::size_t c = 0; c < channels; ++c) sum[c] += weight * values[p * channels + c];
    }
    for (double& component : sum) component = weights > 0 ? component / weights : 0.0;
    return sum;
  }

  // |Q| E(P), Q being the evaluation points that any observation reaches (the others add nothing).
  double error_sum(const std::vector<bool>& retained) const {
    const std::vector<bool> all(positions.size(), true);
    double sum = 0;
    for (const Vector3& q : evaluation_points) {
      const auto full = estimate(q, all);
      const auto thinned = estimate(q, retained);
      for (std::size_t c = 0; c < channels; ++c) sum += (full[c] - thinned[c]) * (full[c] - thinned[c]);
    }
    return sum;
  }

  // What giving up each of the retained, and retaining each of the others, would add to error_sum.
  std::vector<double> increments(const std::vector<bool>& retained) const {
    const double now = error_sum(retained);
    std::vector<double> result(positions.size());
    for (std::size_t p = 0; p < positions.size(); ++p) {
      std::vector<bool> changed = retained;
      changed[p] = !changed[p];
      result[p] = error_sum(changed) - now;
    }
    return result;
  }
};

}  // namespace thin::test
