#pragma once

// Which cells over each patch's plane the patch has taken, and at which height: so that a patch never takes a second
// sheet over the same place, and no cliff in its elevation map.

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
  // anywhere, or next to something at a height to which neither its slope nor that of the other leads: there another
  // part of the patch passes behind its rim. Returns whether it did.
  // leniency: above 1, so many times the height tolerance, and no look at the neighbours.
  bool try_add(std::uint32_t element, std::uint32_t patch, double leniency = 1);

 private:
  static constexpr std::int32_t kTileSize = 16;
  struct Place {
    float height;  // NaN where there is nothing yet
    Slopes slopes;
  };
  using Tile = std::array<Place, kTileSize * kTileSize>;

  // The tile is made where it is missing.
  Place& place_at(std::uint32_t patch, std::int32_t u, std::int32_t v);
  bool leads_to(std::int32_t du, std::int32_t dv, const Cell& cell, const Slopes& slopes, std::uint32_t patch);
  bool leads_to_neighbours(const Cell& cell, const Slopes& slopes, std::uint32_t patch);
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
  std::vector<Place*> places_;  // of cells_
};

}  // namespace emap
