#include "libthin/foundation/lloyd_clustering.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libthin/foundation/cluster_rows.h"
#include "libthin/foundation/kd_tree.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

// Wider than any rounding of distances: what is bounded away by more than this is not nearer.
constexpr double kWidening = 1 + 1e-9;

class Relaxation {
 public:
  Relaxation(const ClusterPoints& points, Clustering& clustering)
      : points_(points),
        rows_(points),
        clustering_(clustering),
        squared_(points.size()),
        next_(points.size()),
        begin_(clustering.size() + 1),
        members_(points.size()),
        has_moved_(clustering.size(), 1) {
    list_members();
    for (std::uint32_t cluster = 0; cluster < clustering.size(); ++cluster) measure_distances(cluster);
  }

  // Whether anything changed.
  bool round() {
    reassign();
    std::vector<std::uint8_t> is_changed(clustering_.size(), 0);
    bool any = false;
    for (std::size_t p = 0; p < next_.size(); ++p) {
      if (next_[p] == clustering_.cluster_of[p]) continue;
      any = true;
      is_changed[next_[p]] = is_changed[clustering_.cluster_of[p]] = 1;
      clustering_.cluster_of[p] = next_[p];
    }
    if (!any) return false;
    list_members();
    move_representatives(is_changed);
    return true;
  }

 private:
  struct Candidate {
    double distance;  // between the representatives
    std::uint32_t cluster;
    bool operator<(const Candidate& other) const {
      return distance != other.distance ? distance < other.distance : cluster < other.cluster;
    }
  };

  std::span<const std::uint32_t> members_of(std::uint32_t cluster) const {
    return std::span(members_).subspan(begin_[cluster], begin_[cluster + 1] - begin_[cluster]);
  }
  const double* place_of(std::uint32_t cluster) const { return rows_.of(clustering_.representative[cluster]); }

  // Ascending in each cluster.
  void list_members() {
    std::fill(begin_.begin(), begin_.end(), 0U);
    for (const std::uint32_t cluster : clustering_.cluster_of) ++begin_[cluster + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::uint32_t> place(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t p = 0; p < members_.size(); ++p) members_[place[clustering_.cluster_of[p]]++] = p;
  }

  void measure_distances(std::uint32_t cluster) {
    for (const std::uint32_t p : members_of(cluster))
      squared_[p] = rows_.distance_squared(rows_.of(p), place_of(cluster));
  }

  void move_representatives(const std::vector<std::uint8_t>& is_changed) {
    parallel_ranges(clustering_.size(), 64, [&](std::size_t first, std::size_t last) {
      std::vector<double> centroid;
      for (auto cluster = static_cast<std::uint32_t>(first); cluster < last; ++cluster) {
        has_moved_[cluster] = 0;
        if (!is_changed[cluster]) continue;
        const std::uint32_t before = clustering_.representative[cluster];
        clustering_.representative[cluster] = mean_of(rows_, members_of(cluster), centroid).point;
        has_moved_[cluster] = clustering_.representative[cluster] != before;
        if (has_moved_[cluster]) measure_distances(cluster);
      }
    });
  }

  // next_ and squared_ by the nearest representatives. A point whose own has not moved can only have come nearer to
  // one that has: all others were compared in an earlier round.
  void reassign() {
    std::vector<std::uint32_t> all(clustering_.size()), moved;
    std::iota(all.begin(), all.end(), 0U);
    std::copy_if(all.begin(), all.end(), std::back_inserter(moved), [&](std::uint32_t c) { return has_moved_[c]; });
    const KdTree near_all = tree_of(all), near_moved = tree_of(moved);
    parallel_ranges(clustering_.size(), 64, [&](std::size_t first, std::size_t last) {
      std::vector<Neighbour> found;
      std::vector<Candidate> candidates;
      for (auto cluster = static_cast<std::uint32_t>(first); cluster < last; ++cluster) {
        const bool is_all = has_moved_[cluster];
        find_candidates(cluster, is_all ? near_all : near_moved, is_all ? all : moved, found, candidates);
        for (const std::uint32_t p : members_of(cluster)) reassign(p, cluster, candidates);
      }
    });
  }

  KdTree tree_of(const std::vector<std::uint32_t>& clusters) const {
    std::vector<double> places;
    places.reserve(clusters.size() * static_cast<std::size_t>(points_.place_dimension));
    for (const std::uint32_t cluster : clusters)
      places.insert(places.end(), place_of(cluster), place_of(cluster) + points_.place_dimension);
    return KdTree(places, points_.place_dimension);
  }

  // The representatives that may be nearer to a member than its own: they are nearer to its own than twice as far as
  // the member is. By ascending distance.
  void find_candidates(std::uint32_t cluster, const KdTree& tree, const std::vector<std::uint32_t>& of_tree,
                       std::vector<Neighbour>& found, std::vector<Candidate>& candidates) const {
    candidates.clear();
    double farthest_squared = 0;
    for (const std::uint32_t p : members_of(cluster)) farthest_squared = std::max(farthest_squared, squared_[p]);
    if (farthest_squared == 0 || tree.size() == 0) return;
    const double reach = 2 * std::sqrt(farthest_squared) * kWidening;
    tree.radius_search({place_of(cluster), static_cast<std::size_t>(points_.place_dimension)}, reach, found);
    for (const Neighbour& neighbour : found) {
      const std::uint32_t other = of_tree[neighbour.index];
      if (other == cluster || !are_of_a_group(cluster, other)) continue;
      const double distance = std::sqrt(rows_.distance_squared(place_of(cluster), place_of(other)));
      if (distance < reach) candidates.push_back({distance, other});
    }
    std::sort(candidates.begin(), candidates.end());
  }

  bool are_of_a_group(std::uint32_t a, std::uint32_t b) const {
    return points_.group.empty() ||
           points_.group[clustering_.representative[a]] == points_.group[clustering_.representative[b]];
  }

  void reassign(std::uint32_t p, std::uint32_t cluster, const std::vector<Candidate>& candidates) {
    next_[p] = cluster;
    const double reach = 2 * std::sqrt(squared_[p]) * kWidening;
    for (const Candidate& candidate : candidates) {
      if (candidate.distance >= reach) break;
      const double squared = rows_.distance_squared(rows_.of(p), place_of(candidate.cluster));
      const bool is_tie = squared == squared_[p] && next_[p] != cluster && candidate.cluster < next_[p];
      if (squared < squared_[p] || is_tie) next_[p] = candidate.cluster, squared_[p] = squared;
    }
  }

  const ClusterPoints& points_;
  ClusterRows rows_;
  Clustering& clustering_;
  std::vector<double> squared_;      // of each point to its representative
  std::vector<std::uint32_t> next_;  // the cluster of each point after this round
  std::vector<std::uint32_t> begin_, members_;
  std::vector<std::uint8_t> has_moved_;  // of each cluster, its representative, in the round before
};

}  // namespace

int relax_clusters(const ClusterPoints& points, Clustering& clustering, int rounds) {
  Relaxation relaxation(points, clustering);
  int round = 0;
  while (round < rounds && relaxation.round()) ++round;
  return round;
}

double sum_of_cluster_errors(const ClusterPoints& points, const Clustering& clustering) {
  const ClusterRows rows(points);
  double sum = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    sum += rows.distance_squared(rows.of(p), rows.of(clustering.representative[clustering.cluster_of[p]]));
  return sum;
}

}  // namespace thin
