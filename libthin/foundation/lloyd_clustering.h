#pragma once

// Points in clusters that one of them stands for: split from the top down by principal axes, then relaxed by Lloyd's
// iterations (thesis 6.3.1). Gersho and Gray 1992 call the same generalised Lloyd with splitting.
//
// Distances are Euclidean over all coordinates. The first `place_dimension` of them say where a point is, the others
// what is found there (in units of a length, so that they can be added): clusters are split across their places, and
// places bound the search for the nearest representative, so that the number of other coordinates is not limited.
// A cluster's mean is, after eq. 6.9, the member with the least sum of squared distances to all members, which is the
// one nearest to their centroid; the error of a cluster is that least sum.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thin {

struct ClusterPoints {
  std::span<const double> coordinates;       // n x dimension, row by row, finite
  int dimension = 3;                         // >= place_dimension
  int place_dimension = 3;                   // 3 to 16, as the kd-tree takes them
  std::span<const std::uint8_t> group = {};  // n, or empty: points of different groups never share a cluster

  std::size_t size() const { return coordinates.size() / static_cast<std::size_t>(dimension); }
};

struct ClusterGoal {
  std::size_t cluster_count = 0;             // no more clusters than this, but one for each group
  std::optional<double> cluster_error = {};  // a cluster is split only while its error exceeds this
};

struct Clustering {
  std::vector<std::uint32_t> cluster_of;      // n
  std::vector<std::uint32_t> representative;  // of each cluster: its mean, an index of a point

  std::size_t size() const { return representative.size(); }
};

// Splits the cluster with the largest error (of equal ones the first), through its centroid across the principal axis
// of its places, until the goal is met or all clusters are single points. Where places are all the same, the axis of
// all coordinates decides, and of equal points the first half goes. O(n log n) for clusters of like size.
Clustering split_clusters(const ClusterPoints& points, const ClusterGoal& goal);

// Lloyd: every point goes to the nearest representative (stays, where none is strictly nearer than its own; of several
// that are, the nearest, then the first), and representatives follow; until nothing changes. Clusters neither appear
// nor vanish, and the sum of their errors falls. Exact: what is skipped cannot be nearer, by the triangle inequality.
// Each round costs about (members of clusters whose representative moved) x (representatives within reach).
// Returns the number of rounds, `rounds` at most; fewer: converged. On all cores; the result is the same for any
// number.
int relax_clusters(const ClusterPoints& points, Clustering& clustering, int rounds);

// The sum over points of the squared distance to the representative of their cluster.
double sum_of_cluster_errors(const ClusterPoints& points, const Clustering& clustering);

}  // namespace thin
