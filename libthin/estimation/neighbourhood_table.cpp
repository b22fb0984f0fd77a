#include "libthin/estimation/neighbourhood_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "libthin/foundation/kd_tree.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

// The box around all observations, wider by the radius: beyond it nothing has a neighbour. A granule covers a small
// part of the globe whose grid it is held against.
class Reach {
 public:
  Reach(const Places& places, double radius_km)
      : low_(static_cast<std::size_t>(places.dimension), kFar),
        high_(static_cast<std::size_t>(places.dimension), -kFar) {
    const double margin_km = radius_km * (1 + 1e-9);
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t axis = 0; axis < low_.size(); ++axis) {
        low_[axis] = std::min(low_[axis], places.of(i)[axis] - margin_km);
        high_[axis] = std::max(high_[axis], places.of(i)[axis] + margin_km);
      }
  }
  const std::vector<double>& low() const { return low_; }
  bool holds(std::span<const double> place) const {
    for (std::size_t axis = 0; axis < low_.size(); ++axis)
      if (place[axis] < low_[axis] || place[axis] > high_[axis]) return false;
    return true;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> low_, high_;
};

// Evaluation points that lie near to each other, in an order that follows a space-filling curve: what is within reach
// of one is nearly what is within reach of the next, so one search in the tree serves a whole run of them.
struct Run {
  std::uint32_t first = 0, count = 0;  // places in the order
};

constexpr std::uint32_t kLongestRun = 32;

// The bits of the cell numbers along each axis, interleaved (Morton order).
std::uint64_t curve_key(std::span<const double> place, const std::vector<double>& low, double cell_km) {
  constexpr double most = 65535;
  std::uint64_t key = 0;
  std::uint32_t cells[4] = {};
  for (std::size_t axis = 0; axis < place.size(); ++axis)
    cells[axis] = static_cast<std::uint32_t>(std::clamp((place[axis] - low[axis]) / cell_km, 0.0, most));
  for (int bit = 15; bit >= 0; --bit)
    for (std::size_t axis = 0; axis < place.size(); ++axis) key = key << 1 | (cells[axis] >> bit & 1);
  return key;
}

// The neighbourhoods of the points of some runs, found by one thread.
struct Block {
  std::vector<std::uint32_t> observation;
  std::vector<double> weight;
};

class Search {
 public:
  Search(const Places& points, const Places& observations, const GaussianFilter& filter)
      : points_(points),
        observations_(observations),
        filter_(filter),
        tree_(observations.coordinates, observations.dimension) {
    const Reach reach(observations, filter.radius_km());
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    for (std::uint32_t q = 0; q < points.size(); ++q)
      if (reach.holds(points.of(q))) keys.emplace_back(curve_key(points.of(q), reach.low(), filter.radius_km() / 4), q);
    std::sort(keys.begin(), keys.end());
    for (const auto& [key, q] : keys) order_.push_back(q);
    cut_into_runs();
  }

  std::size_t point_count() const { return points_.size(); }
  std::size_t run_count() const { return runs_.size(); }
  std::span<const std::uint32_t> points_of(std::size_t run) const {
    return std::span(order_).subspan(runs_[run].first, runs_[run].count);
  }

  struct Scratch {
    std::vector<Neighbour> found;
    std::vector<double> coordinates;  // of the candidates, axis by axis
    std::vector<double> distance_squared;
    std::vector<std::uint32_t> near;
    std::vector<double> near_distance_squared;
  };

  // Appends the observations within reach of each point of the run, in the order of points_of(), each by ascending
  // index; counts[q] becomes the number for each point q.
  void search(std::size_t run, Scratch& scratch, std::uint32_t* counts, Block& block) const {
    gather_candidates(run, scratch);
    for (const std::uint32_t q : points_of(run)) {
      const std::size_t count = filter_candidates(q, scratch);
      counts[q] = static_cast<std::uint32_t>(count);
      block.observation.insert(block.observation.end(), scratch.near.begin(),
                               scratch.near.begin() + static_cast<std::ptrdiff_t>(count));
      block.weight.resize(block.weight.size() + count);
      filter_.weigh(std::span(scratch.near_distance_squared).first(count),
                    block.weight.data() + block.weight.size() - count);
    }
  }

 private:
  void cut_into_runs() {
    const auto dimension = static_cast<std::size_t>(points_.dimension);
    std::vector<double> low(dimension), high(dimension);
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
      const auto place = points_.of(order_[i]);
      bool fits = !runs_.empty() && runs_.back().count < kLongestRun;
      for (std::size_t axis = 0; fits && axis < dimension; ++axis)
        fits = std::max(high[axis], place[axis]) - std::min(low[axis], place[axis]) <= filter_.radius_km() / 2;
      if (!fits) {
        runs_.push_back({i, 0});
        std::copy(place.begin(), place.end(), low.begin());
        std::copy(place.begin(), place.end(), high.begin());
      }
      for (std::size_t axis = 0; axis < dimension; ++axis) {
        low[axis] = std::min(low[axis], place[axis]);
        high[axis] = std::max(high[axis], place[axis]);
      }
      ++runs_.back().count;
    }
  }

  // All observations within reach of any point of the run, and more, by ascending index.
  void gather_candidates(std::size_t run, Scratch& scratch) const {
    const auto dimension = static_cast<std::size_t>(points_.dimension);
    double centre[4] = {}, farthest_squared = 0;
    for (const std::uint32_t q : points_of(run))
      for (std::size_t axis = 0; axis < dimension; ++axis)
        centre[axis] += points_.of(q)[axis] / static_cast<double>(runs_[run].count);
    for (const std::uint32_t q : points_of(run)) {
      double squared = 0;
      for (std::size_t axis = 0; axis < dimension; ++axis)
        squared += (points_.of(q)[axis] - centre[axis]) * (points_.of(q)[axis] - centre[axis]);
      farthest_squared = std::max(farthest_squared, squared);
    }
    // Wider by more than all rounding: Earth-centred coordinates are exact to 1e-12 of themselves.
    const double radius_km = (filter_.radius_km() + std::sqrt(farthest_squared)) * (1 + 1e-9) + 1e-6;
    tree_.radius_search({centre, dimension}, radius_km, scratch.found);
    const std::size_t count = scratch.found.size();
    scratch.coordinates.resize(count * dimension);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t axis = 0; axis < dimension; ++axis)
        scratch.coordinates[axis * count + i] = observations_.of(scratch.found[i].index)[axis];
    scratch.distance_squared.resize(count);
    scratch.near.resize(count);
    scratch.near_distance_squared.resize(count);
  }

  std::size_t filter_candidates(std::uint32_t q, Scratch& scratch) const {
    const std::size_t candidates = scratch.found.size();
    double* squared = scratch.distance_squared.data();
    std::fill(squared, squared + candidates, 0.0);
    for (std::size_t axis = 0; axis < points_.of(q).size(); ++axis) {
      const double at = points_.of(q)[axis];
      const double* coordinate = scratch.coordinates.data() + axis * candidates;
      for (std::size_t i = 0; i < candidates; ++i) squared[i] += (at - coordinate[i]) * (at - coordinate[i]);
    }
    const double radius_squared = filter_.radius_km() * filter_.radius_km();
    const bool grouped = !observations_.group.empty();
    std::size_t count = 0;
    for (std::size_t i = 0; i < candidates; ++i) {
      const std::uint32_t p = scratch.found[i].index;
      scratch.near[count] = p;
      scratch.near_distance_squared[count] = squared[i];
      count += squared[i] <= radius_squared && (!grouped || observations_.group[p] == points_.group_of(q));
    }
    return count;
  }

  const Places& points_;
  const Places& observations_;
  const GaussianFilter& filter_;
  KdTree tree_;
  std::vector<std::uint32_t> order_;  // the points that may have neighbours, along the curve
  std::vector<Run> runs_;
};

constexpr std::size_t kRunsPerBlock = 16;
constexpr std::size_t kSampledRuns = 50;

Error too_large(const Search& search, std::size_t observations, const GaussianFilter& filter, double entries,
                const std::string& limit) {
  return {ErrorKind::configuration,
          fmt::format("{} observations and {} evaluation points within {:g} km make {:.3g} pairs, {}; choose a smaller "
                      "bandwidth_km, a coarser level, or shorter windows",
                      observations, search.point_count(), filter.radius_km(), entries, limit)};
}

// Looks at evenly spread points before anything large is allocated.
Result<void> expect_to_fit(const Search& search, std::size_t observations, const GaussianFilter& filter,
                           std::uint64_t memory_bytes) {
  Search::Scratch scratch;
  Block block;
  std::vector<std::uint32_t> counts(search.point_count());
  const std::size_t stride = std::max<std::size_t>(1, search.run_count() / kSampledRuns);
  double seen = 0;
  for (std::size_t run = 0; run < search.run_count(); run += stride, ++seen)
    search.search(run, scratch, counts.data(), block);
  const double entries =
      seen > 0 ? static_cast<double>(block.observation.size()) / seen * static_cast<double>(search.run_count()) : 0;
  const double bytes = entries * static_cast<double>(kBytesPerEntry);
  if (bytes > static_cast<double>(memory_bytes))
    return too_large(search, observations, filter, entries,
                     fmt::format("which need about {:.1f} GiB of memory where {:.1f} are left", bytes / (1 << 30),
                                 static_cast<double>(memory_bytes) / (1 << 30)));
  return {};
}

// Brings the rows of the blocks into the order of the points. Each block is freed as soon as it is copied.
NeighbourhoodTable joined(const Search& search, std::vector<Block>& blocks, const std::vector<std::uint32_t>& counts,
                          bool keep_empty_rows, std::vector<std::uint32_t>* kept_points) {
  NeighbourhoodTable table;
  std::vector<std::uint64_t> begin_of(counts.size());
  table.row_begin.push_back(0);
  for (std::uint32_t q = 0; q < counts.size(); ++q) {
    begin_of[q] = table.row_begin.back();
    if (counts[q] == 0 && !keep_empty_rows) continue;
    table.row_begin.push_back(table.row_begin.back() + counts[q]);
    if (kept_points) kept_points->push_back(q);
  }
  assign_in_large_pages(table.observation, table.row_begin.back());
  assign_in_large_pages(table.weight, table.row_begin.back());
  parallel_ranges(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::ptrdiff_t next = 0;
      for (std::size_t run = i * kRunsPerBlock; run < std::min((i + 1) * kRunsPerBlock, search.run_count()); ++run)
        for (const std::uint32_t q : search.points_of(run)) {
          const auto to = static_cast<std::ptrdiff_t>(begin_of[q]);
          std::copy_n(blocks[i].observation.begin() + next, counts[q], table.observation.begin() + to);
          std::copy_n(blocks[i].weight.begin() + next, counts[q], table.weight.begin() + to);
          next += counts[q];
        }
      blocks[i] = {};
    }
  });
  return table;
}

void add_columns(NeighbourhoodTable& table) {
  table.column_begin.assign(table.observations + 1, 0);
  for (const std::uint32_t p : table.observation) ++table.column_begin[p + 1];
  for (std::size_t p = 0; p < table.observations; ++p) table.column_begin[p + 1] += table.column_begin[p];

  std::vector<std::uint64_t> next(table.column_begin.begin(), table.column_begin.end() - 1);
  assign_in_large_pages(table.column_point, table.entry_count());
  assign_in_large_pages(table.column_weight, table.entry_count());
  for (std::size_t q = 0; q < table.evaluation_point_count(); ++q)
    for (std::uint64_t entry = table.row_begin[q]; entry < table.row_begin[q + 1]; ++entry) {
      const std::uint64_t place = next[table.observation[entry]]++;
      table.column_point[place] = static_cast<std::uint32_t>(q);
      table.column_weight[place] = table.weight[entry];
    }
}

Result<NeighbourhoodTable> rows_of(const Search& search, const Places& observations, const GaussianFilter& filter,
                                   bool keep_empty_rows, std::vector<std::uint32_t>* kept_points,
                                   std::uint64_t memory_bytes) {
  if (Result<void> fits = expect_to_fit(search, observations.size(), filter, memory_bytes); !fits) return fits.error();
  std::vector<Block> blocks((search.run_count() + kRunsPerBlock - 1) / kRunsPerBlock);
  std::vector<std::uint32_t> counts(search.point_count(), 0);
  parallel_ranges(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
    Search::Scratch scratch;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t run = i * kRunsPerBlock; run < std::min((i + 1) * kRunsPerBlock, search.run_count()); ++run)
        search.search(run, scratch, counts.data(), blocks[i]);
  });
  std::uint64_t entries = 0;
  for (const std::uint32_t count : counts) entries += count;
  if (entries > std::numeric_limits<std::uint32_t>::max())
    return too_large(search, observations.size(), filter, static_cast<double>(entries), "more than fit");
  NeighbourhoodTable table = joined(search, blocks, counts, keep_empty_rows, kept_points);
  table.observations = observations.size();
  return table;
}

}  // namespace

Result<NeighbourhoodTable> neighbourhood_table(const Places& evaluation_points, const Places& observations,
                                               const GaussianFilter& filter, std::vector<std::uint32_t>* kept_points,
                                               std::uint64_t memory_bytes) {
  Result<NeighbourhoodTable> table =
      rows_of(Search(evaluation_points, observations, filter), observations, filter, false, kept_points, memory_bytes);
  if (table) add_columns(*table);
  return table;
}

Result<NeighbourhoodTable> neighbourhood_table(const Places& observations, const GaussianFilter& filter,
                                               std::uint64_t memory_bytes) {
  return rows_of(Search(observations, observations, filter), observations, filter, true, nullptr, memory_bytes);
}

Result<NeighbourhoodTable> neighbourhood_rows(const Places& evaluation_points, const Places& observations,
                                              const GaussianFilter& filter) {
  return rows_of(Search(evaluation_points, observations, filter), observations, filter, true, nullptr,
                 std::numeric_limits<std::uint64_t>::max());
}

void each_neighbourhood(const Places& evaluation_points, const Places& observations, const GaussianFilter& filter,
                        const NeighbourhoodBody& body) {
  const Search search(evaluation_points, observations, filter);
  std::vector<std::uint32_t> counts(search.point_count(), 0);
  parallel_ranges(search.run_count(), kRunsPerBlock, [&](std::size_t begin, std::size_t end) {
    Search::Scratch scratch;
    Block block;
    for (std::size_t run = begin; run < end; ++run) {
      block.observation.clear();
      block.weight.clear();
      search.search(run, scratch, counts.data(), block);
      std::size_t next = 0;
      for (const std::uint32_t q : search.points_of(run)) {
        body(q, std::span(block.observation).subspan(next, counts[q]),
             std::span(block.weight).subspan(next, counts[q]));
        next += counts[q];
      }
    }
  });
}

}  // namespace thin
