#include "libemap/partition/sheet_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace emap {
namespace {

constexpr std::uint32_t kNoTile = std::numeric_limits<std::uint32_t>::max();

// What noise may add to a slope over one cell.
constexpr float kSlopeSlack = 0.5F;

std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ (value >> 31)) * 0x9E3779B97F4A7C15ULL;
  return value ^ (value >> 29);
}

}  // namespace

SheetMap::SheetMap(const Footprints& footprints) : footprints_(footprints), table_(1024, {0, 0, 0, kNoTile}) {}

std::uint32_t SheetMap::add_patch(const Eigen::Vector3d& normal) {
  axes_.push_back(axes_around(normal));
  return static_cast<std::uint32_t>(axes_.size() - 1);
}

bool SheetMap::try_add(std::uint32_t element, std::uint32_t patch, double leniency) {
  cells_.clear();
  places_.clear();
  const std::optional<Slopes> slopes = footprints_.append_cells(element, axes_[patch], cells_);
  const double tolerance = leniency * footprints_.height_tolerance();
  const bool looks_around = leniency <= 1 && std::isfinite(tolerance);
  for (const Cell& cell : cells_) {
    places_.push_back(&place_at(patch, cell.u, cell.v));
    if (std::abs(places_.back()->height - cell.height) > tolerance)
      return false;  // not so where there is no height yet
    if (slopes && looks_around && !leads_to_neighbours(cell, *slopes, patch)) return false;
  }
  if (cells_.empty() && slopes && looks_around) {
    const Cell centre = footprints_.centre_cell(element, axes_[patch], *slopes);
    return leads_to(0, 0, centre, *slopes, patch) && leads_to_neighbours(centre, *slopes, patch);
  }
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (std::isnan(places_[i]->height)) *places_[i] = {cells_[i].height, slopes.value_or(Slopes{})};
  return true;
}

// Whether what lies so many cells away, if anything, is at a height to which the element's slopes or its own lead.
bool SheetMap::leads_to(std::int32_t du, std::int32_t dv, const Cell& cell, const Slopes& slopes, std::uint32_t patch) {
  const Place& other = place_at(patch, cell.u + du, cell.v + dv);
  if (std::isnan(other.height)) return true;
  const auto step = static_cast<float>(footprints_.cell_size());
  const auto slack = static_cast<float>(footprints_.height_tolerance()) +
                     step * (1 + kSlopeSlack * std::max(std::abs(slopes.u), std::abs(slopes.v)));
  const float own = step * (slopes.u * static_cast<float>(du) + slopes.v * static_cast<float>(dv));
  const float others = step * (other.slopes.u * static_cast<float>(du) + other.slopes.v * static_cast<float>(dv));
  const float rise = other.height - cell.height;
  return rise >= std::min(own, others) - slack && rise <= std::max(own, others) + slack;
}

bool SheetMap::leads_to_neighbours(const Cell& cell, const Slopes& slopes, std::uint32_t patch) {
  return leads_to(1, 0, cell, slopes, patch) && leads_to(-1, 0, cell, slopes, patch) &&
         leads_to(0, 1, cell, slopes, patch) && leads_to(0, -1, cell, slopes, patch);
}

SheetMap::Place& SheetMap::place_at(std::uint32_t patch, std::int32_t u, std::int32_t v) {
  static_assert(kTileSize == 1 << 4);
  Tile& tile = tiles_[tile_at(patch, u >> 4, v >> 4)];
  return tile[static_cast<std::size_t>((v & (kTileSize - 1)) * kTileSize + (u & (kTileSize - 1)))];
}

std::size_t SheetMap::slot_of(std::uint32_t patch, std::int32_t tile_u, std::int32_t tile_v) const {
  const std::uint64_t key = mixed(mixed((std::uint64_t{patch} << 32) ^ static_cast<std::uint32_t>(tile_u)) ^
                                  static_cast<std::uint32_t>(tile_v));
  std::size_t slot = key & (table_.size() - 1);
  for (;; slot = (slot + 1) & (table_.size() - 1)) {
    const TableEntry& entry = table_[slot];
    if (entry.tile == kNoTile || (entry.patch == patch && entry.tile_u == tile_u && entry.tile_v == tile_v))
      return slot;
  }
}

std::uint32_t SheetMap::tile_at(std::uint32_t patch, std::int32_t tile_u, std::int32_t tile_v) {
  std::size_t slot = slot_of(patch, tile_u, tile_v);
  if (table_[slot].tile != kNoTile) return table_[slot].tile;
  if (2 * (tiles_.size() + 1) > table_.size()) {
    grow_table();
    slot = slot_of(patch, tile_u, tile_v);
  }
  table_[slot] = {patch, tile_u, tile_v, static_cast<std::uint32_t>(tiles_.size())};
  tiles_.emplace_back().fill({std::numeric_limits<float>::quiet_NaN(), {}});
  return table_[slot].tile;
}

void SheetMap::grow_table() {
  const std::vector<TableEntry> entries = std::move(table_);
  table_.assign(2 * entries.size(), {0, 0, 0, kNoTile});
  for (const TableEntry& entry : entries)
    if (entry.tile != kNoTile) table_[slot_of(entry.patch, entry.tile_u, entry.tile_v)] = entry;
}

}  // namespace emap
