#include "libthin/thinning/octree.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace thin {
namespace {

constexpr double kRootCellKm = 12800;

double square(double x) {
  return x * x;
}

double distance_squared(const Vector3& a, const Vector3& b) {
  return square(a.x - b.x) + square(a.y - b.y) + square(a.z - b.z);
}

std::size_t octant_of(const Vector3& position, const Vector3& centre) {
  return (position.x >= centre.x ? 1U : 0U) + (position.y >= centre.y ? 2U : 0U) + (position.z >= centre.z ? 4U : 0U);
}

std::uint32_t nearest_to_centre(const ThinningInput& input, const std::vector<std::uint32_t>& members,
                                const Vector3& centre) {
  const auto& positions = input.observations.position_km;
  return *std::min_element(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (input.has_priority(a, b) || input.has_priority(b, a)) return input.has_priority(a, b);
    return distance_squared(positions[a], centre) < distance_squared(positions[b], centre);
  });
}

}  // namespace

struct Octree::Cell {
  Vector3 centre_km;
  double side_km;
  std::vector<std::uint32_t> members;  // ascending
};

double probability_of_more(double sum, double degrees_of_freedom) {
  const double spread = 2 / (9 * degrees_of_freedom);
  const double deviations = (std::cbrt(sum / degrees_of_freedom) - (1 - spread)) / std::sqrt(spread);
  return std::erfc(deviations / std::numbers::sqrt2) / 2;
}

void Octree::declare_options(OptionTable& table) {
  table.add(
      "value_tolerance", value_tolerance_k_,
      {.unit = "K",
       .maximum = 1000,
       .above = 0,
       .explanation = "standard deviation that the observations of a cell may have, such as their noise (in units "
                      "of observation_errors, if given)"});
  table.add("significance", significance_,
            {.maximum = 1,
             .above = 0,
             .explanation = "a cell is split where its values would vary so much with less than this probability"});
  table.add("minimum_cell_km", minimum_cell_km_,
            {.unit = "km", .minimum = 1, .maximum = kRootCellKm, .explanation = "no cell is smaller"});
  table.add(
      "maximum_cell_km", maximum_cell_km_,
      {.unit = "km", .minimum = 1, .maximum = kRootCellKm, .explanation = "no cell with two observations is larger"});
}

std::optional<ThinningMethod::Conflict> Octree::conflict() const {
  if (maximum_cell_km_ >= 2 * minimum_cell_km_) return std::nullopt;
  return Conflict{"maximum_cell_km", fmt::format("must be at least twice minimum_cell_km = {}, not {}",
                                                 minimum_cell_km_, maximum_cell_km_)};
}

bool Octree::is_to_be_split(const ThinningInput& input, const Cell& cell) const {
  if (cell.members.size() < 2 || cell.side_km / 2 < minimum_cell_km_) return false;
  if (cell.side_km > maximum_cell_km_) return true;
  const auto count = static_cast<double>(cell.members.size());
  double sum = 0, channels = 0;
  for (std::size_t c = 0; c < input.channel_count(); ++c) {
    if (!input.observations.measures(cell.members.front(), c)) continue;
    double mean = 0, squares = 0;
    for (const std::uint32_t i : cell.members) mean += input.values_of(i)[c] / count;
    for (const std::uint32_t i : cell.members) squares += square((input.values_of(i)[c] - mean) / value_tolerance_k_);
    sum += squares;
    ++channels;
  }
  return channels > 0 && probability_of_more(sum, (count - 1) * channels) < significance_;
}

Result<Choice> Octree::choose(const ThinningInput& input) const {
  std::map<std::uint8_t, Cell> roots;
  for (std::uint32_t i = 0; i < input.size(); ++i)
    roots.try_emplace(input.places.group_of(i), Cell{{}, kRootCellKm, {}}).first->second.members.push_back(i);
  std::vector<Cell> pending;
  for (auto& [group, root] : roots) pending.push_back(std::move(root));

  Choice choice;
  while (!pending.empty()) {
    const Cell cell = std::move(pending.back());
    pending.pop_back();
    if (!is_to_be_split(input, cell)) {
      choice.retained.push_back(nearest_to_centre(input, cell.members, cell.centre_km));
      continue;
    }
    std::array<std::vector<std::uint32_t>, 8> parts;
    for (const std::uint32_t i : cell.members)
      parts[octant_of(input.observations.position_km[i], cell.centre_km)].push_back(i);
    for (std::size_t octant = 0; octant < parts.size(); ++octant) {
      if (parts[octant].empty()) continue;
      const double step_km = cell.side_km / 4;
      const Vector3 centre{cell.centre_km.x + (octant & 1 ? step_km : -step_km),
                           cell.centre_km.y + (octant & 2 ? step_km : -step_km),
                           cell.centre_km.z + (octant & 4 ? step_km : -step_km)};
      pending.push_back({centre, cell.side_km / 2, std::move(parts[octant])});
    }
  }
  std::sort(choice.retained.begin(), choice.retained.end());
  return choice;
}

}  // namespace thin
