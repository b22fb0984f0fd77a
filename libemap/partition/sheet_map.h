#pragma once

// Which cells over each patch's plane the patch has taken, and at which height: so that a patch never takes a second
// sheet over the same place.

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "libemap/partition/footprints.h"

namespace emap {

class SheetMap {
 public:
  // The footprints must outlive the map.
  explicit SheetMap(const Footprints& footprints);

  // Opens the map of the next patch, whose number is returned: 0, 1, 2, ...
  std::uint32_t add_patch(const Eigen::Vector3d& normal);
  const Eigen::Vector3d& normal(std::uint32_t patch) const { return axes_[patch].normal; }
  std::size_t patch_count() const { return axes_.size(); }

  // Takes the element into the patch, unless it lies over or under what is there by more than the height tolerance
  // anywhere. Returns whether it did.
  bool try_add(std::uint32_t element, std::uint32_t patch);

 private:
  static constexpr std::int32_t kTileSize = 16;
  using Tile = std::array<float, kTileSize * kTileSize>;

  // The stored height at a cell, NaN where there is none yet; the tile is made where it is missing.
  float& height_at(std::uint32_t patch, const Cell& cell);
  std::uint32_t tile_at(std::uint32_t patch, std::int32_t tile_u, std::int32_t tile_v);
  void grow_table();

  struct TableEntry {
    std::uint32_t patch;
    std::int32_t tile_u, tile_v;
    std::uint32_t tile;  // index, or kNoTile
  };
  std::size_t slot_of(std::uint32_t patch, std::int32_t tile_u, std::int32_t tile_v) const;

  const Footprints& footprints_;
  std::vector<PlaneAxes> axes_;
  std::deque<Tile> tiles_;         // never moved
  std::vector<TableEntry> table_;  // open addressing; a power of two long
  std::vector<Cell> cells_;
  std::vector<float*> places_;  // of cells_
};

}  // namespace emap
