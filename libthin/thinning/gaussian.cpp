#include "libthin/thinning/gaussian.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libthin/observations/geodesy.h"
#include "libthin/observations/time.h"
#include "libthin/thinning/cells.h"

namespace thin {
namespace {

constexpr double kSmallestMeshKm = 0.1;
constexpr std::int64_t kMostTimeBins = 1'000'000;

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

// Haversine of the angle between two places on the sphere: in the order of their distance.
double haversine(double latitude_a_deg, double latitude_b_deg, double longitude_difference_deg) {
  const double over = std::sin(radians(latitude_a_deg - latitude_b_deg) / 2);
  const double along = std::sin(radians(longitude_difference_deg) / 2);
  return over * over + std::cos(radians(latitude_a_deg)) * std::cos(radians(latitude_b_deg)) * along * along;
}

std::optional<std::string> not_a_time(const std::optional<std::string>& text) {
  if (!text || from_iso8601(*text)) return std::nullopt;
  return fmt::format("must be a time such as \"2018-04-14T21:00:00Z\", not \"{}\"", *text);
}

}  // namespace

struct Gaussian::TimeBins {
  std::int64_t first_ms, width_ms, count;

  std::int64_t bin_of(std::int64_t time_ms) const {
    return std::clamp<std::int64_t>((time_ms - first_ms) / width_ms, 0, count - 1);
  }
  // From the middle of the bin, in widths.
  double distance(std::int64_t time_ms) const {
    const double place = static_cast<double>(time_ms - first_ms) / static_cast<double>(width_ms);
    return std::abs(place - (static_cast<double>(bin_of(time_ms)) + 0.5));
  }
};

void Gaussian::declare_options(OptionTable& table) {
  table.add("horizontal_mesh", horizontal_mesh_km_,
            {.unit = "km",
             .maximum = 100000,
             .explanation = "height of the latitude bands; 0 or negative: place does not count"});
  table.add("use_reduced_horizontal_grid", use_reduced_horizontal_grid_,
            {.explanation = "fewer cells towards the poles; else as many in every band"});
  table.add("round_horizontal_bin_count_to_nearest", round_horizontal_bin_count_to_nearest_,
            {.explanation = "bands and cells as near to the mesh as possible; else never smaller"});
  table.add("partition_longitude_bins_using_mesh", partition_longitude_bins_using_mesh_,
            {.explanation = "cells in a band are as wide as the mesh asks for, not as the bands are high"});
  table.add("define_meridian_20000_km", define_meridian_20000_km_,
            {.explanation = "count bands as if the meridian were 20000 km long, not 20015.087"});
  table.add("time_mesh", time_mesh_,
            {.explanation = "length of the cells in time, such as \"PT1H\"; counts only with time_min and time_max"});
  table.add("time_min", time_min_, {.explanation = "where the first cell in time begins: \"2018-04-14T21:00:00Z\""});
  table.add("time_max", time_max_, {.explanation = "where the last cell in time ends, rounded up to a whole cell"});
  table.add_choice("distance_norm", distance_norm_,
                   std::vector<std::pair<std::string, DistanceNorm>>{{"geodesic", DistanceNorm::geodesic},
                                                                     {"maximum", DistanceNorm::maximum}},
                   {.explanation = "retained is the nearest to the cell's centre on the Earth, or the one farthest "
                                   "inside the cell as a unit cube, time included"});
  table.add("tiebreaker_pick_latest", tiebreaker_pick_latest_,
            {.explanation = "of equally good observations retain the latest; else the first"});
}

std::optional<ThinningMethod::Conflict> Gaussian::conflict() const {
  if (horizontal_mesh_km_ > 0 && horizontal_mesh_km_ < kSmallestMeshKm)
    return Conflict{"horizontal_mesh",
                    fmt::format("must be at least {} km, or 0 for none, not {}", kSmallestMeshKm, horizontal_mesh_km_)};
  if (time_mesh_ && !duration_ms_from_iso8601(*time_mesh_))
    return Conflict{"time_mesh", fmt::format("must be a duration such as \"PT1H\", not \"{}\"", *time_mesh_)};
  if (const auto problem = not_a_time(time_min_)) return Conflict{"time_min", *problem};
  if (const auto problem = not_a_time(time_max_)) return Conflict{"time_max", *problem};
  if (const auto bins = time_bins(); bins && bins->count > kMostTimeBins)
    return Conflict{"time_mesh", fmt::format("cuts the time from time_min to time_max into {} cells; {} at most",
                                             bins->count, kMostTimeBins)};
  return std::nullopt;
}

std::optional<Gaussian::TimeBins> Gaussian::time_bins() const {
  if (!time_mesh_ || !time_min_ || !time_max_) return std::nullopt;
  const auto width_ms = duration_ms_from_iso8601(*time_mesh_);
  const auto first_ms = from_iso8601(*time_min_), last_ms = from_iso8601(*time_max_);
  if (!width_ms || *width_ms <= 0 || !first_ms || !last_ms) return std::nullopt;
  return TimeBins{*first_ms, *width_ms, std::max<std::int64_t>(1, (*last_ms - *first_ms + *width_ms - 1) / *width_ms)};
}

LatitudeLongitudeMesh Gaussian::mesh() const {
  using Mesh = LatitudeLongitudeMesh;
  const auto rounding = round_horizontal_bin_count_to_nearest_ ? Mesh::Rounding::nearest : Mesh::Rounding::down;
  constexpr double meridian_km = std::numbers::pi * 6371.0;
  const double bands = (define_meridian_20000_km_ ? 20000 : meridian_km) / horizontal_mesh_km_;
  const std::int64_t whole_bands = Mesh::rounded(bands, rounding);
  if (!use_reduced_horizontal_grid_) return Mesh::regular(whole_bands, 2 * whole_bands);
  const double around_equator = partition_longitude_bins_using_mesh_ ? 2 * meridian_km / horizontal_mesh_km_
                                                                     : 2 * static_cast<double>(whole_bands);
  return Mesh::reduced(whole_bands, around_equator, rounding);
}

Result<Choice> Gaussian::choose(const ThinningInput& input) const {
  const ObservationSet& observations = input.observations;
  std::vector<std::uint64_t> cells(input.size(), 0);
  std::vector<double> distance(input.size(), 0.0);
  const bool is_maximum = distance_norm_ == DistanceNorm::maximum;

  if (horizontal_mesh_km_ > 0) {
    const LatitudeLongitudeMesh boxes = mesh();
    for (std::size_t i = 0; i < input.size(); ++i) {
      const double latitude_deg = observations.latitude_deg[i], longitude_deg = observations.longitude_deg[i];
      const auto box = boxes.box_of(latitude_deg, longitude_deg);
      const double over_deg = latitude_deg - boxes.centre_latitude_deg(box);
      const double along_deg = normalised_longitude_deg(longitude_deg - boxes.centre_longitude_deg(box));
      cells[i] = boxes.number(box);
      distance[i] = is_maximum
                        ? std::max(std::abs(over_deg) / boxes.height_deg(), std::abs(along_deg) / boxes.width_deg(box))
                        : haversine(latitude_deg, boxes.centre_latitude_deg(box), along_deg);
    }
  }
  const std::optional<TimeBins> times = time_bins();
  for (std::size_t i = 0; times && i < input.size(); ++i) {
    cells[i] = cells[i] * static_cast<std::uint64_t>(times->count) +
               static_cast<std::uint64_t>(times->bin_of(observations.time_ms[i]));
    if (is_maximum) distance[i] = std::max(distance[i], times->distance(observations.time_ms[i]));
  }

  Choice choice;
  if (time_mesh_ && !times) choice.notes.push_back("time_mesh counts only together with time_min and time_max");
  choice.retained = best_of_each_cell(cells, [&](std::uint32_t a, std::uint32_t b) {
    if (input.has_priority(a, b) || input.has_priority(b, a)) return input.has_priority(a, b);
    if (distance[a] != distance[b]) return distance[a] < distance[b];
    return tiebreaker_pick_latest_ && observations.time_ms[a] > observations.time_ms[b];
  });
  return choice;
}

}  // namespace thin
