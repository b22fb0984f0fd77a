#pragma once

// Exact neighbour search among fixed points in 3 to 16 dimensions.
//
// Building is O(n log n), a query O(log n + found). For a handful of points, or for a query that finds most of them, a
// plain loop is faster. Results depend on the coordinates alone: ties are ordered by index and the boundary of a radius
// belongs to it. Queries are const and may run on many threads.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace thin {

struct Neighbour {
  std::uint32_t index;
  double distance_squared;
  bool operator==(const Neighbour&) const = default;
};

class KdTree {
 public:
  // coordinates: n x dimension, row by row; copied. n may be 0.
  // REQUIRES: 3 <= dimension <= 16, every coordinate finite.
  KdTree(std::span<const double> coordinates, int dimension);
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  std::size_t size() const;
  int dimension() const;

  // All points at distance <= radius of `query`, by ascending index. `found` is replaced; its capacity is reused.
  void radius_search(std::span<const double> query, double radius, std::vector<Neighbour>& found) const;

  // The `count` nearest points (all, where there are fewer), by ascending distance, then index.
  void nearest(std::span<const double> query, std::size_t count, std::vector<Neighbour>& found) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace thin
