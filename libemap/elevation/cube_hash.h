#pragma once

// Items by the cubes of a regular grid in space that they touch; cubes are made as they are needed.

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace emap {

class CubeHash {
 public:
  explicit CubeHash(double side) : side_(side), table_(1024) {}

  // Files the item under every cube that the box touches.
  void add(std::uint32_t item, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    visit_cubes(low, high, [&](const Cube& cube) { add_to(cube, item); });
  }
  // The same, but only under cubes that hold something already in `where`.
  void add_where(const CubeHash& where, std::uint32_t item, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    visit_cubes(low, high, [&](const Cube& cube) {
      if (where.table_[where.slot_of(cube)].first != kNone) add_to(cube, item);
    });
  }
  // Makes the cubes of the box hold something, whatever it is.
  void mark(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    visit_cubes(low, high, [&](const Cube& cube) {
      if (table_[slot_of(cube)].first == kNone) add_to(cube, 0);
    });
  }

  // Whether some cube that the box touches holds something.
  bool touches(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
    bool any = false;
    visit_cubes(low, high, [&](const Cube& cube) { any = any || table_[slot_of(cube)].first != kNone; });
    return any;
  }
  // Whether every cube that the box touches holds something.
  bool covers(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
    bool all = true;
    visit_cubes(low, high, [&](const Cube& cube) { all = all && table_[slot_of(cube)].first != kNone; });
    return all;
  }

  // Calls visit(item) for the items filed under the cubes that the box touches; once for each such cube.
  template <class Visitor>
  void visit(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Visitor& visitor) const {
    visit_cubes(low, high, [&](const Cube& cube) {
      for (std::uint32_t entry = table_[slot_of(cube)].first; entry != kNone; entry = entries_[entry].next)
        visitor(entries_[entry].item);
    });
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Cube {
    std::int32_t x = 0, y = 0, z = 0;
    bool operator==(const Cube&) const = default;
  };
  struct Slot {
    Cube cube;
    std::uint32_t first = kNone;  // entry
  };
  struct Entry {
    std::uint32_t item, next;
  };

  template <class Visitor>
  void visit_cubes(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Visitor& visitor) const {
    const auto index = [this](double coordinate) { return static_cast<std::int32_t>(std::floor(coordinate / side_)); };
    for (std::int32_t z = index(low.z()); z <= index(high.z()); ++z)
      for (std::int32_t y = index(low.y()); y <= index(high.y()); ++y)
        for (std::int32_t x = index(low.x()); x <= index(high.x()); ++x) visitor(Cube{x, y, z});
  }

  std::size_t slot_of(const Cube& cube) const {
    std::uint64_t hash = static_cast<std::uint32_t>(cube.x);
    for (const std::int32_t component : {cube.y, cube.z})
      hash = (hash ^ (hash >> 29) ^ static_cast<std::uint32_t>(component)) * 0x9E3779B97F4A7C15ULL;
    std::size_t slot = (hash ^ (hash >> 32)) & (table_.size() - 1);
    while (table_[slot].first != kNone && !(table_[slot].cube == cube)) slot = (slot + 1) & (table_.size() - 1);
    return slot;
  }

  void add_to(const Cube& cube, std::uint32_t item) {
    std::size_t slot = slot_of(cube);
    if (table_[slot].first == kNone && 2 * ++used_ > table_.size()) {
      grow();
      slot = slot_of(cube);
    }
    entries_.push_back({item, table_[slot].first});
    table_[slot] = {cube, static_cast<std::uint32_t>(entries_.size() - 1)};
  }

  void grow() {
    const std::vector<Slot> slots = std::move(table_);
    table_.assign(2 * slots.size(), {});
    for (const Slot& slot : slots)
      if (slot.first != kNone) table_[slot_of(slot.cube)] = slot;
  }

  double side_;
  std::size_t used_ = 0;
  std::vector<Slot> table_;  // open addressing; a power of two long
  std::vector<Entry> entries_;
};

}  // namespace emap
