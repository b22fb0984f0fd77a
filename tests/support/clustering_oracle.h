#pragma once

// Lloyd's iterations with representatives by trying all: every point against every representative, every member as the
// mean of its cluster.

#include <cmath>
#include <cstdint>
#include <vector>

#include "libthin/foundation/lloyd_clustering.h"

namespace thin::test {

struct ClusteringOracle {
  const ClusterPoints& points;

  double distance_squared(std::size_t a, std::size_t b) const {
    const auto dimension = static_cast<std::size_t>(points.dimension);
    double sum = 0;
    for (std::size_t i = 0; i < dimension; ++i) {
      const double difference = points.coordinates[a * dimension + i] - points.coordinates[b * dimension + i];
      sum += difference * difference;
    }
    return sum;
  }

  // e(C, p) of eq. 6.9.
  double error(const Clustering& clustering, std::uint32_t cluster, std::size_t mean) const {
    double sum = 0;
    for (std::size_t p = 0; p < points.size(); ++p)
      if (clustering.cluster_of[p] == cluster) sum += distance_squared(p, mean);
    return sum;
  }

  double least_error(const Clustering& clustering, std::uint32_t cluster) const {
    double least = HUGE_VAL;
    for (std::size_t p = 0; p < points.size(); ++p)
      if (clustering.cluster_of[p] == cluster) least = std::min(least, error(clustering, cluster, p));
    return least;
  }

  std::uint32_t mean(const Clustering& clustering, std::uint32_t cluster) const {
    std::uint32_t best = 0;
    double least = HUGE_VAL;
    for (std::uint32_t p = 0; p < points.size(); ++p) {
      if (clustering.cluster_of[p] != cluster) continue;
      const double squares = error(clustering, cluster, p);
      if (squares < least * (1 - 1e-9)) best = p, least = squares;  // all but rounding apart, the first
    }
    return best;
  }

  bool is_same_group(std::size_t a, std::size_t b) const {
    return points.group.empty() || points.group[a] == points.group[b];
  }

  // Whether anything changed.
  bool round(Clustering& clustering) const {
    bool any = false;
    const std::vector<std::uint32_t> before = clustering.cluster_of;
    for (std::size_t p = 0; p < points.size(); ++p) {
      double nearest = distance_squared(p, clustering.representative[before[p]]);
      for (std::uint32_t cluster = 0; cluster < clustering.size(); ++cluster) {
        const std::uint32_t representative = clustering.representative[cluster];
        if (!is_same_group(p, representative) || distance_squared(p, representative) >= nearest) continue;
        nearest = distance_squared(p, representative);
        clustering.cluster_of[p] = cluster;
        any = true;
      }
    }
    for (std::uint32_t cluster = 0; any && cluster < clustering.size(); ++cluster)
      clustering.representative[cluster] = mean(clustering, cluster);
    return any;
  }
};

}  // namespace thin::test
