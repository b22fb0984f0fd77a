#include "libthin/foundation/lloyd_clustering.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "libthin/foundation/indexed_priority_queue.h"
#include "libthin/foundation/kd_tree.h"
#include "libthin/foundation/parallel.h"
#include "libthin/foundation/principal_axes.h"

namespace thin {
namespace {

// Wider than any rounding of distances: what is bounded away by more than this is not nearer.
constexpr double kWidening = 1 + 1e-9;
// Of two members that are equally near to the centroid but for rounding, the first is the mean.
constexpr double kEquallyNear = 1 - 1e-9;

// The points with rows filled up with zeros to whole groups of lanes, so that distances take few instructions and are
// summed in one order everywhere.
class Rows {
 public:
  explicit Rows(const ClusterPoints& points) : width_((static_cast<std::size_t>(points.dimension) + 3) / 4 * 4) {
    const auto dimension = static_cast<std::size_t>(points.dimension);
    coordinates_.resize(points.size() * width_);
    for (std::size_t p = 0; p < points.size(); ++p)
      std::copy_n(points.coordinates.begin() + static_cast<std::ptrdiff_t>(p * dimension), dimension,
                  coordinates_.begin() + static_cast<std::ptrdiff_t>(p * width_));
  }

  std::size_t width() const { return width_; }
  const double* of(std::size_t p) const { return coordinates_.data() + p * width_; }

  double distance_squared(const double* a, const double* b) const {
    double sum[4] = {};
    for (std::size_t i = 0; i < width_; i += 4)
      for (std::size_t lane = 0; lane < 4; ++lane)
        sum[lane] += (a[i + lane] - b[i + lane]) * (a[i + lane] - b[i + lane]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }

 private:
  std::size_t width_;
  std::vector<double> coordinates_;
};

struct Mean {
  std::uint32_t point = 0;
  double error = 0;  // of the cluster
};

// REQUIRES: members ascending, not empty. `centroid` is replaced.
Mean mean_of(const Rows& rows, std::span<const std::uint32_t> members, std::vector<double>& centroid) {
  centroid.assign(rows.width(), 0.0);
  for (const std::uint32_t p : members)
    for (std::size_t i = 0; i < rows.width(); ++i) centroid[i] += rows.of(p)[i];
  const auto count = static_cast<double>(members.size());
  for (double& component : centroid) component /= count;

  Mean mean{members.front(), 0};
  double nearest = rows.distance_squared(rows.of(mean.point), centroid.data());
  for (const std::uint32_t p : members) {
    const double squared = rows.distance_squared(rows.of(p), centroid.data());
    mean.error += squared;
    if (squared < nearest * kEquallyNear) mean.point = p, nearest = squared;
  }
  // About any point, the sum of squares is that about the centroid and as often the squared distance to it.
  mean.error = members.size() > 1 ? mean.error + count * nearest : 0;
  return mean;
}

// Clusters as consecutive ranges of one permutation, each ascending.
class Splitting {
 public:
  explicit Splitting(const ClusterPoints& points) : points_(points), rows_(points), members_(points.size()) {
    std::iota(members_.begin(), members_.end(), 0U);
    if (!points.group.empty())
      std::stable_sort(members_.begin(), members_.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return points.group[a] < points.group[b]; });
    queue_ = IndexedPriorityQueue<double>(points.size());
    for (std::uint32_t begin = 0; begin < members_.size();) {
      std::uint32_t end = begin + 1;
      while (end < members_.size() &&
             (points.group.empty() || points.group[members_[end]] == points.group[members_[begin]]))
        ++end;
      add({begin, end});
      begin = end;
    }
  }

  void run(const ClusterGoal& goal) {
    while (ranges_.size() < goal.cluster_count && !queue_.empty()) {
      if (goal.cluster_error && -queue_.top_key() <= *goal.cluster_error) break;
      const std::uint32_t cluster = queue_.pop();
      const Range range = ranges_[cluster];
      const std::uint32_t middle = split(range);
      measure(cluster, {range.begin, middle});
      add({middle, range.end});
    }
  }

  Clustering result() const {
    Clustering clustering{std::vector<std::uint32_t>(members_.size()), representative_};
    for (std::uint32_t cluster = 0; cluster < ranges_.size(); ++cluster)
      for (const std::uint32_t p : members_in(ranges_[cluster])) clustering.cluster_of[p] = cluster;
    return clustering;
  }

 private:
  struct Range {
    std::uint32_t begin, end;
  };

  std::span<const std::uint32_t> members_in(const Range& range) const {
    return std::span(members_).subspan(range.begin, range.end - range.begin);
  }

  void add(const Range& range) {
    ranges_.push_back(range);
    representative_.push_back(0);
    measure(static_cast<std::uint32_t>(ranges_.size() - 1), range);
  }

  void measure(std::uint32_t cluster, const Range& range) {
    const Mean mean = mean_of(rows_, members_in(range), centroid_);
    ranges_[cluster] = range;
    representative_[cluster] = mean.point;
    if (range.end - range.begin > 1) queue_.push(cluster, -mean.error);
  }

  // Returns where the second part begins. REQUIRES: two members at least
  std::uint32_t split(const Range& range) {
    for (const int dimension : {points_.place_dimension, points_.dimension}) {
      const std::uint32_t middle = split_across_axis(range, dimension);
      if (middle > range.begin && middle < range.end) return middle;
    }
    return range.begin + (range.end - range.begin) / 2;
  }

  // By the first so many coordinates. Either part may be empty.
  std::uint32_t split_across_axis(const Range& range, int dimension) {
    buffer_.clear();
    for (const std::uint32_t p : members_in(range)) buffer_.insert(buffer_.end(), rows_.of(p), rows_.of(p) + dimension);
    const PrincipalAxes axes = principal_axes(buffer_, dimension);
    const auto is_first = [&](std::uint32_t p) {
      double along = 0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i)
        along += (rows_.of(p)[i] - axes.centroid[i]) * axes.axis(0)[i];
      return along <= 0;
    };
    second_.clear();
    std::uint32_t middle = range.begin;
    for (std::uint32_t place = range.begin; place < range.end; ++place) {
      const std::uint32_t p = members_[place];
      if (is_first(p))
        members_[middle++] = p;
      else
        second_.push_back(p);
    }
    std::copy(second_.begin(), second_.end(), members_.begin() + middle);
    return middle;
  }

  const ClusterPoints& points_;
  Rows rows_;
  std::vector<std::uint32_t> members_;
  std::vector<Range> ranges_;
  std::vector<std::uint32_t> representative_;
  IndexedPriorityQueue<double> queue_;  // of clusters that can be split, by descending error
  std::vector<double> centroid_, buffer_;
  std::vector<std::uint32_t> second_;
};

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
  Rows rows_;
  Clustering& clustering_;
  std::vector<double> squared_;      // of each point to its representative
  std::vector<std::uint32_t> next_;  // the cluster of each point after this round
  std::vector<std::uint32_t> begin_, members_;
  std::vector<std::uint8_t> has_moved_;  // of each cluster, its representative, in the round before
};

void check(const ClusterPoints& points) {
  assert(points.place_dimension >= 3 && points.place_dimension <= 16);
  assert(points.dimension >= points.place_dimension);
  assert(points.group.empty() || points.group.size() == points.size());
  static_cast<void>(points);
}

}  // namespace

Clustering split_clusters(const ClusterPoints& points, const ClusterGoal& goal) {
  check(points);
  Splitting splitting(points);
  splitting.run(goal);
  return splitting.result();
}

int relax_clusters(const ClusterPoints& points, Clustering& clustering, int rounds) {
  check(points);
  Relaxation relaxation(points, clustering);
  int round = 0;
  while (round < rounds && relaxation.round()) ++round;
  return round;
}

double sum_of_cluster_errors(const ClusterPoints& points, const Clustering& clustering) {
  const Rows rows(points);
  double sum = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    sum += rows.distance_squared(rows.of(p), rows.of(clustering.representative[clustering.cluster_of[p]]));
  return sum;
}

}  // namespace thin
