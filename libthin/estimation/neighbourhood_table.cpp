#include "libthin/estimation/neighbourhood_table.h"

#include <fmt/format.h>

#include <algorithm>
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
  bool holds(std::span<const double> place) const {
    for (std::size_t axis = 0; axis < low_.size(); ++axis)
      if (place[axis] < low_[axis] || place[axis] > high_[axis]) return false;
    return true;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> low_, high_;
};

class Search {
 public:
  Search(const Places& points, const Places& observations, const GaussianFilter& filter)
      : points_(points),
        observations_(observations),
        filter_(filter),
        tree_(observations.coordinates, observations.dimension),
        reach_(observations, filter.radius_km()) {}

  std::size_t point_count() const { return points_.size(); }

  // The observations of q's group within reach of it, by ascending index.
  void run(std::size_t q, std::vector<Neighbour>& found) const {
    found.clear();
    if (!reach_.holds(points_.of(q))) return;
    tree_.radius_search(points_.of(q), filter_.radius_km(), found);
    if (!observations_.group.empty())
      std::erase_if(found, [&](const Neighbour& n) { return observations_.group[n.index] != points_.group_of(q); });
  }

  double weight(const Neighbour& neighbour) const { return filter_.weight(neighbour.distance_squared); }

 private:
  const Places& points_;
  const Places& observations_;
  const GaussianFilter& filter_;
  KdTree tree_;
  Reach reach_;
};

// The neighbourhoods of a run of consecutive evaluation points, found by one thread.
struct Block {
  std::vector<std::uint32_t> counts;
  std::vector<std::uint32_t> observation;
  std::vector<double> weight;
};

constexpr std::size_t kBlockSize = 256;
constexpr std::size_t kSampleSize = 1000;

Block search_block(const Search& search, std::size_t first, std::size_t count) {
  Block block;
  std::vector<Neighbour> found;
  for (std::size_t q = first; q < first + count; ++q) {
    search.run(q, found);
    block.counts.push_back(static_cast<std::uint32_t>(found.size()));
    for (const Neighbour& neighbour : found) {
      block.observation.push_back(neighbour.index);
      block.weight.push_back(search.weight(neighbour));
    }
  }
  return block;
}

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
  std::vector<Neighbour> found;
  const std::size_t stride = std::max<std::size_t>(1, search.point_count() / kSampleSize);
  double sampled = 0, seen = 0;
  for (std::size_t q = 0; q < search.point_count(); q += stride, ++seen) {
    search.run(q, found);
    sampled += static_cast<double>(found.size());
  }
  const double entries = seen > 0 ? sampled / seen * static_cast<double>(search.point_count()) : 0;
  const double bytes = entries * static_cast<double>(kBytesPerEntry);
  if (bytes > static_cast<double>(memory_bytes))
    return too_large(search, observations, filter, entries,
                     fmt::format("which need about {:.1f} GiB of memory where {:.1f} are left", bytes / (1 << 30),
                                 static_cast<double>(memory_bytes) / (1 << 30)));
  return {};
}

// Puts the blocks one behind the other; each is freed as soon as it is copied.
NeighbourhoodTable joined(std::vector<Block>& blocks, std::uint64_t entries, bool keep_empty_rows,
                          std::vector<std::uint32_t>* kept_points) {
  NeighbourhoodTable table;
  table.row_begin.push_back(0);
  table.observation.reserve(entries);
  table.weight.reserve(entries);
  std::uint32_t point = 0;
  for (Block& block : blocks) {
    for (const std::uint32_t count : block.counts) {
      if (count > 0 || keep_empty_rows) {
        table.row_begin.push_back(table.row_begin.back() + count);
        if (kept_points) kept_points->push_back(point);
      }
      ++point;
    }
    table.observation.insert(table.observation.end(), block.observation.begin(), block.observation.end());
    table.weight.insert(table.weight.end(), block.weight.begin(), block.weight.end());
    block = {};
  }
  return table;
}

void add_columns(NeighbourhoodTable& table) {
  table.column_begin.assign(table.observations + 1, 0);
  for (const std::uint32_t p : table.observation) ++table.column_begin[p + 1];
  for (std::size_t p = 0; p < table.observations; ++p) table.column_begin[p + 1] += table.column_begin[p];

  std::vector<std::uint64_t> next(table.column_begin.begin(), table.column_begin.end() - 1);
  table.column_point.resize(table.entry_count());
  table.column_weight.resize(table.entry_count());
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
  std::vector<Block> blocks((search.point_count() + kBlockSize - 1) / kBlockSize);
  parallel_ranges(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = i * kBlockSize;
      blocks[i] = search_block(search, first, std::min(kBlockSize, search.point_count() - first));
    }
  });
  std::uint64_t entries = 0;
  for (const Block& block : blocks) entries += block.observation.size();
  if (entries > std::numeric_limits<std::uint32_t>::max())
    return too_large(search, observations.size(), filter, static_cast<double>(entries), "more than fit");
  NeighbourhoodTable table = joined(blocks, entries, keep_empty_rows, kept_points);
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

}  // namespace thin
