#include "libthin/estimation/places.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace thin {
namespace {

constexpr double kMsPerHour = 3'600'000;

// Of the fourth coordinate.
std::vector<double> time_levels(const Places& observations, double time_step_km) {
  std::vector<double> levels;
  if (observations.dimension < 4 || observations.size() == 0) return levels;
  double first = observations.of(0)[3], last = first;
  for (std::size_t i = 1; i < observations.size(); ++i) {
    first = std::min(first, observations.of(i)[3]);
    last = std::max(last, observations.of(i)[3]);
  }
  const auto steps = static_cast<std::size_t>(std::ceil((last - first) / time_step_km));
  for (std::size_t i = 0; i <= steps; ++i)
    levels.push_back(steps ? first + (last - first) * static_cast<double>(i) / static_cast<double>(steps) : first);
  return levels;
}

}  // namespace

Places places_at(std::span<const Vector3> positions_km) {
  Places places;
  places.coordinates.reserve(positions_km.size() * 3);
  for (const Vector3& p : positions_km) places.coordinates.insert(places.coordinates.end(), {p.x, p.y, p.z});
  return places;
}

Places places_of(const ObservationSet& observations, double time_scale_km_per_hour) {
  Places places = places_at(observations.position_km);
  if (time_scale_km_per_hour > 0) {
    // From the first on, so that the coordinates stay small numbers.
    const auto first = std::min_element(observations.time_ms.begin(), observations.time_ms.end());
    std::vector<double> with_time;
    with_time.reserve(observations.size() * 4);
    for (std::size_t i = 0; i < observations.size(); ++i) {
      const auto position = places.of(i);
      with_time.insert(with_time.end(), position.begin(), position.end());
      with_time.push_back(time_scale_km_per_hour * static_cast<double>(observations.time_ms[i] - *first) / kMsPerHour);
    }
    places.coordinates = std::move(with_time);
    places.dimension = 4;
  }
  if (!observations.channel_instrument.empty())
    for (const Instrument whose : observations.instrument) places.group.push_back(static_cast<std::uint8_t>(whose));
  return places;
}

Places evaluation_places(std::span<const Vector3> positions_km, const Places& observations, double time_step_km) {
  std::vector<double> levels = time_levels(observations, time_step_km);
  const std::size_t level_count = std::max<std::size_t>(levels.size(), 1);
  const std::set<std::uint8_t> groups(observations.group.begin(), observations.group.end());
  const std::size_t group_count = std::max<std::size_t>(groups.size(), 1);

  Places places;
  places.dimension = observations.dimension;
  places.coordinates.reserve(positions_km.size() * level_count * group_count *
                             static_cast<std::size_t>(places.dimension));
  auto group = groups.begin();
  for (std::size_t g = 0; g < group_count; ++g) {
    for (std::size_t level = 0; level < level_count; ++level)
      for (const Vector3& p : positions_km) {
        places.coordinates.insert(places.coordinates.end(), {p.x, p.y, p.z});
        if (places.dimension == 4) places.coordinates.push_back(levels.empty() ? 0 : levels[level]);
      }
    if (group != groups.end()) places.group.resize(places.size(), *group++);
  }
  return places;
}

}  // namespace thin
