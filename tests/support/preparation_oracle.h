#pragma once

// The preparation's searches from their definitions, every pair looked at.

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "libthin/observations/geodesy.h"
#include "libthin/observations/observation_set.h"
#include "libthin/observations/shore_edge.h"

namespace thin::test {

inline bool are_duplicates(const ObservationSet& set, std::size_t a, std::size_t b, double km, double minutes) {
  return set.platform[a] == set.platform[b] && set.instrument[a] == set.instrument[b] &&
         set.field_of_view[a] == set.field_of_view[b] && chord_km(set.position_km[a], set.position_km[b]) <= km &&
         std::abs(static_cast<double>(set.time_ms[a] - set.time_ms[b])) <= minutes * 60'000;
}

// Whether each observation is kept: again and again the best of what is left, whose duplicates go. O(n^3).
inline std::vector<bool> kept_by_brute_force(const ObservationSet& set, double km, double minutes,
                                             const std::function<bool(std::size_t, std::size_t)>& is_better) {
  enum class State { open, kept, gone };
  std::vector<State> states(set.size(), State::open);
  for (;;) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < set.size(); ++i)
      if (states[i] == State::open && (!best || is_better(i, *best))) best = i;
    if (!best) break;
    states[*best] = State::kept;
    for (std::size_t i = 0; i < set.size(); ++i)
      if (states[i] == State::open && are_duplicates(set, *best, i, km, minutes)) states[i] = State::gone;
  }
  std::vector<bool> kept;
  for (const State state : states) kept.push_back(state == State::kept);
  return kept;
}

// The companion of observation i, by every candidate. Companions in canonical order.
inline std::optional<std::size_t> companion_by_brute_force(const ObservationSet& set, std::size_t i,
                                                           const ObservationSet& companions, double km,
                                                           double minutes) {
  std::optional<std::size_t> best;
  const auto key = [&](std::size_t j) {
    return std::tuple(chord_km(set.position_km[i], companions.position_km[j]),
                      std::abs(static_cast<double>(set.time_ms[i] - companions.time_ms[j])), j);
  };
  for (std::size_t j = 0; j < companions.size(); ++j) {
    const bool same_view = set.field_of_view[i] == companions.field_of_view[j] ||
                           set.field_of_view[i] == kUnknownNumber || companions.field_of_view[j] == kUnknownNumber;
    if (!same_view || set.platform[i] != companions.platform[j] || set.instrument[i] != companions.instrument[j])
      continue;
    if (std::get<0>(key(j)) > km || std::get<1>(key(j)) > minutes * 60'000) continue;
    if (!best || key(j) < key(*best)) best = j;
  }
  return best;
}

// Whether a point lies within a set of edges, by the winding of all of them in the plane of longitude and latitude: a
// ray to the west instead of the north, with the plane repeated to both sides. Edges of closed polygons, no pole
// inside.
inline bool is_inside_by_brute_force(const std::vector<ShoreEdge>& edges, double latitude, double longitude) {
  bool inside = false;
  for (const ShoreEdge& edge : edges)
    for (const double turn : {-360.0, 0.0, 360.0}) {
      const double x1 = edge.from_longitude_deg + turn, x2 = edge.to_longitude_deg + turn;
      const double y1 = edge.from_latitude_deg, y2 = edge.to_latitude_deg;
      if ((y1 > latitude) == (y2 > latitude)) continue;
      if (x1 + (x2 - x1) * (latitude - y1) / (y2 - y1) < longitude) inside = !inside;
    }
  return inside;
}

// For the whole world's land, no edge of which crosses the meridian of 0: by the crossings of a line from the south
// pole, where land is, to the point.
inline bool is_land_seen_from_the_south(const std::vector<ShoreEdge>& edges, double latitude, double longitude) {
  bool land = true;
  for (const ShoreEdge& edge : edges) {
    const double west = std::min(edge.from_longitude_deg, edge.to_longitude_deg);
    const double east = std::max(edge.from_longitude_deg, edge.to_longitude_deg);
    if (longitude < west || longitude >= east) continue;
    const double share = (longitude - edge.from_longitude_deg) / (edge.to_longitude_deg - edge.from_longitude_deg);
    if (edge.from_latitude_deg + share * (edge.to_latitude_deg - edge.from_latitude_deg) < latitude) land = !land;
  }
  return land;
}

// Least distance from a position to all edges, each cut into short straight pieces. km
inline double shore_distance_by_brute_force(const std::vector<ShoreEdge>& edges, const Vector3& position_km,
                                            int pieces_per_edge) {
  double least = 1e9;
  for (const ShoreEdge& edge : edges)
    for (int piece = 0; piece <= pieces_per_edge; ++piece) {
      const double share = static_cast<double>(piece) / pieces_per_edge;
      const Vector3 point = geocentric_km(std::lerp(edge.from_latitude_deg, edge.to_latitude_deg, share),
                                          std::lerp(edge.from_longitude_deg, edge.to_longitude_deg, share));
      least = std::min(least, chord_km(position_km, point));
    }
  return least;
}

}  // namespace thin::test
