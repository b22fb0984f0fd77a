#include "libthin/foundation/kd_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

// FLANN is not written for -Wconversion and friends.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#pragma GCC diagnostic pop

namespace thin {
namespace {

using FlannTree = flann::KDTreeSingleIndex<flann::L2<double>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// FLANN prunes with distances that it accumulates in its own order, and treats its bound as exclusive. Candidates are
// gathered up to a bound wider by far more than that rounding, and judged by `distance_squared` alone.
double widened(double bound) {
  return bound * (1 + 1e-9) + std::numeric_limits<double>::min();
}

bool nearer(const Neighbour& a, const Neighbour& b) {
  return a.distance_squared != b.distance_squared ? a.distance_squared < b.distance_squared : a.index < b.index;
}

}  // namespace

struct KdTree::Index {
  std::vector<double> coordinates;
  std::size_t size = 0;
  int dimension = 0;
  std::unique_ptr<FlannTree> tree;  // absent without points

  double distance_squared(std::span<const double> query, std::size_t point) const {
    double sum = 0;
    for (int axis = 0; axis < dimension; ++axis) {
      const double difference = query[axis] - coordinates[point * dimension + axis];
      sum += difference * difference;
    }
    return sum;
  }
};

namespace {

// FLANN's callback: keeps what lies within a fixed radius.
template <class Distance>
class RadiusCollector : public flann::ResultSet<double> {
 public:
  RadiusCollector(Distance distance, double radius_squared, std::vector<Neighbour>& found)
      : distance_(distance), radius_squared_(radius_squared), found_(found) {}
  bool full() const override { return true; }
  double worstDist() const override { return widened(radius_squared_); }
  void addPoint(double, std::size_t point) override {
    const double exact = distance_(point);
    if (exact <= radius_squared_) found_.push_back({static_cast<std::uint32_t>(point), exact});
  }

 private:
  Distance distance_;
  double radius_squared_;
  std::vector<Neighbour>& found_;
};

// FLANN's callback: a max-heap of the `count` nearest so far, by (distance, index).
template <class Distance>
class NearestCollector : public flann::ResultSet<double> {
 public:
  NearestCollector(Distance distance, std::size_t count, std::vector<Neighbour>& found)
      : distance_(distance), count_(count), found_(found) {}
  bool full() const override { return found_.size() == count_; }
  double worstDist() const override { return full() ? widened(found_.front().distance_squared) : kInfinity; }
  void addPoint(double, std::size_t point) override {
    const Neighbour candidate{static_cast<std::uint32_t>(point), distance_(point)};
    if (full()) {
      if (!nearer(candidate, found_.front())) return;
      std::pop_heap(found_.begin(), found_.end(), nearer);
      found_.pop_back();
    }
    found_.push_back(candidate);
    std::push_heap(found_.begin(), found_.end(), nearer);
  }

 private:
  Distance distance_;
  std::size_t count_;
  std::vector<Neighbour>& found_;
};

}  // namespace

KdTree::KdTree(std::span<const double> coordinates, int dimension) : index_(std::make_unique<Index>()) {
  assert(dimension >= 3 && dimension <= 16);
  assert(coordinates.size() % static_cast<std::size_t>(dimension) == 0);
  assert(std::all_of(coordinates.begin(), coordinates.end(), [](double x) { return std::isfinite(x); }));
  index_->coordinates.assign(coordinates.begin(), coordinates.end());
  index_->dimension = dimension;
  index_->size = coordinates.size() / static_cast<std::size_t>(dimension);
  if (index_->size == 0) return;
  const flann::Matrix<double> rows(index_->coordinates.data(), index_->size, static_cast<std::size_t>(dimension));
  index_->tree = std::make_unique<FlannTree>(rows, flann::KDTreeSingleIndexParams(10));
  index_->tree->buildIndex();
}

KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

std::size_t KdTree::size() const {
  return index_->size;
}
int KdTree::dimension() const {
  return index_->dimension;
}

void KdTree::radius_search(std::span<const double> query, double radius, std::vector<Neighbour>& found) const {
  assert(static_cast<int>(query.size()) == index_->dimension);
  found.clear();
  if (!index_->tree || !(radius >= 0)) return;
  const auto distance = [&](std::size_t point) { return index_->distance_squared(query, point); };
  RadiusCollector collector(distance, radius * radius, found);
  index_->tree->findNeighbors(collector, query.data(), flann::SearchParams(-1, 0, false));
  std::sort(found.begin(), found.end(), [](const Neighbour& a, const Neighbour& b) { return a.index < b.index; });
}

void KdTree::nearest(std::span<const double> query, std::size_t count, std::vector<Neighbour>& found) const {
  assert(static_cast<int>(query.size()) == index_->dimension);
  found.clear();
  if (!index_->tree || count == 0) return;
  const auto distance = [&](std::size_t point) { return index_->distance_squared(query, point); };
  NearestCollector collector(distance, std::min(count, index_->size), found);
  index_->tree->findNeighbors(collector, query.data(), flann::SearchParams(-1, 0, false));
  std::sort_heap(found.begin(), found.end(), nearer);
}

}  // namespace thin
