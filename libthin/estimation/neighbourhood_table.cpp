#include "libthin/estimation/neighbourhood_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "libthin/foundation/kd_tree.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

static_assert(sizeof(Vector3) == 3 * sizeof(double));

std::span<const double> coordinates(std::span<const Vector3> positions) {
  return {reinterpret_cast<const double*>(positions.data()), positions.size() * 3};
}

// The box around all observations, wider by the radius: beyond it nothing has a neighbour. A granule covers a small
// part of the globe whose grid it is held against.
class Reach {
 public:
  Reach(std::span<const Vector3> positions, double radius_km) {
    for (const Vector3& p : positions) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
    }
    const double margin_km = radius_km * (1 + 1e-9);
    low_ = {low_.x - margin_km, low_.y - margin_km, low_.z - margin_km};
    high_ = {high_.x + margin_km, high_.y + margin_km, high_.z + margin_km};
  }
  bool holds(const Vector3& p) const {
    return p.x >= low_.x && p.x <= high_.x && p.y >= low_.y && p.y <= high_.y && p.z >= low_.z && p.z <= high_.z;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  Vector3 low_{kFar, kFar, kFar};
  Vector3 high_{-kFar, -kFar, -kFar};
};

// The neighbourhoods of a run of consecutive evaluation points, found by one thread.
struct Block {
  std::vector<std::uint32_t> counts;
  std::vector<std::uint32_t> observation;
  std::vector<double> weight;
};

constexpr std::size_t kBlockSize = 256;

Block search_block(const KdTree& tree, const Reach& reach, std::span<const Vector3> points,
                   const GaussianFilter& filter) {
  Block block;
  std::vector<Neighbour> found;
  for (const Vector3& point : points) {
    found.clear();
    if (reach.holds(point)) tree.radius_search(coordinates({&point, 1}), filter.radius_km(), found);
    block.counts.push_back(static_cast<std::uint32_t>(found.size()));
    for (const Neighbour& neighbour : found) {
      block.observation.push_back(neighbour.index);
      block.weight.push_back(filter.weight(neighbour.distance_squared));
    }
  }
  return block;
}

void add_columns(NeighbourhoodTable& table, std::size_t observation_count) {
  table.column_begin.assign(observation_count + 1, 0);
  for (const std::uint32_t p : table.observation) ++table.column_begin[p + 1];
  for (std::size_t p = 0; p < observation_count; ++p) table.column_begin[p + 1] += table.column_begin[p];

  std::vector<std::uint64_t> next(table.column_begin.begin(), table.column_begin.end() - 1);
  table.evaluation_point.resize(table.entry_count());
  table.column_weight.resize(table.entry_count());
  for (std::size_t q = 0; q < table.evaluation_point_count(); ++q)
    for (std::uint64_t entry = table.row_begin[q]; entry < table.row_begin[q + 1]; ++entry) {
      const std::uint64_t place = next[table.observation[entry]]++;
      table.evaluation_point[place] = static_cast<std::uint32_t>(q);
      table.column_weight[place] = table.weight[entry];
    }
}

}  // namespace

Result<NeighbourhoodTable> neighbourhood_table(std::span<const Vector3> evaluation_points,
                                               std::span<const Vector3> observations, const GaussianFilter& filter,
                                               std::vector<std::uint32_t>* kept_points) {
  const KdTree tree(coordinates(observations), 3);
  const Reach reach(observations, filter.radius_km());
  std::vector<Block> blocks((evaluation_points.size() + kBlockSize - 1) / kBlockSize);
  parallel_ranges(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = i * kBlockSize;
      const std::size_t count = std::min(kBlockSize, evaluation_points.size() - first);
      blocks[i] = search_block(tree, reach, evaluation_points.subspan(first, count), filter);
    }
  });

  std::uint64_t entries = 0;
  for (const Block& block : blocks) entries += block.observation.size();
  if (entries > std::numeric_limits<std::uint32_t>::max())
    return Error{ErrorKind::configuration,
                 fmt::format("{} observations and {} evaluation points within {:g} km make {} pairs, more than fit; "
                             "choose a smaller bandwidth_km or a coarser level",
                             observations.size(), evaluation_points.size(), filter.radius_km(), entries)};

  NeighbourhoodTable table;
  table.row_begin.push_back(0);
  table.observation.reserve(entries);
  table.weight.reserve(entries);
  std::uint32_t point = 0;
  for (Block& block : blocks) {
    for (const std::uint32_t count : block.counts) {
      if (count > 0) {
        table.row_begin.push_back(table.row_begin.back() + count);
        if (kept_points) kept_points->push_back(point);
      }
      ++point;
    }
    table.observation.insert(table.observation.end(), block.observation.begin(), block.observation.end());
    table.weight.insert(table.weight.end(), block.weight.begin(), block.weight.end());
    block = {};
  }
  add_columns(table, observations.size());
  return table;
}

}  // namespace thin
