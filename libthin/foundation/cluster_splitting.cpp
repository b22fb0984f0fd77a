#include <algorithm>
#include <numeric>

#include "libthin/foundation/cluster_rows.h"
#include "libthin/foundation/indexed_priority_queue.h"
#include "libthin/foundation/lloyd_clustering.h"
#include "libthin/foundation/principal_axes.h"

namespace thin {
namespace {

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
    const ClusterMean mean = mean_of(rows_, members_in(range), centroid_);
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
  ClusterRows rows_;
  std::vector<std::uint32_t> members_;
  std::vector<Range> ranges_;
  std::vector<std::uint32_t> representative_;
  IndexedPriorityQueue<double> queue_;  // of clusters that can be split, by descending error
  std::vector<double> centroid_, buffer_;
  std::vector<std::uint32_t> second_;
};

}  // namespace

Clustering split_clusters(const ClusterPoints& points, const ClusterGoal& goal) {
  Splitting splitting(points);
  splitting.run(goal);
  return splitting.result();
}

}  // namespace thin
