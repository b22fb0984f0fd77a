#include "libthin/thinning/poisson_disk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "libthin/foundation/kd_tree.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

constexpr double kSphereRadiusKm = 6371.0;
constexpr double kSpacingWithoutAnyKm = 100;

// A number for each observation that looks random (splitmix64), the same with every compiler.
std::uint64_t scrambled(std::uint64_t seed, std::uint64_t i) {
  std::uint64_t bits = seed * 0xd1342543de82ef95 + (i + 1) * 0x9e3779b97f4a7c15;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
  return bits ^ (bits >> 31);
}

std::vector<std::uint32_t> order_of(const ThinningInput& input, bool shuffle, std::uint64_t seed) {
  std::vector<std::uint32_t> order(input.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<std::uint64_t> lot(input.size(), 0);
  if (shuffle)
    for (std::size_t i = 0; i < lot.size(); ++i) lot[i] = scrambled(seed, i);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (input.has_priority(a, b) || input.has_priority(b, a)) return input.has_priority(a, b);
    return lot[a] < lot[b];
  });
  return order;
}

constexpr int kDimension = 4;

// On the sphere, and in time, in units of the spacings; 0 in what does not count.
std::vector<double> scaled_places(const ObservationSet& observations, double spacing_km, std::int64_t spacing_ms) {
  std::vector<double> places(observations.size() * kDimension, 0.0);
  // The straight line through the Earth that belongs to the spacing along its surface, in Earth radii.
  const double chord = 2 * std::sin(std::min(spacing_km / kSphereRadiusKm, std::numbers::pi) / 2);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    double* place = places.data() + i * kDimension;
    if (spacing_km > 0) {
      const double latitude = observations.latitude_deg[i] * std::numbers::pi / 180;
      const double longitude = observations.longitude_deg[i] * std::numbers::pi / 180;
      place[0] = std::cos(latitude) * std::cos(longitude) / chord;
      place[1] = std::cos(latitude) * std::sin(longitude) / chord;
      place[2] = std::sin(latitude) / chord;
    }
    if (spacing_ms > 0)
      place[3] =
          static_cast<double>(observations.time_ms[i] - observations.time_ms[0]) / static_cast<double>(spacing_ms);
  }
  return places;
}

// Whether b is inside the exclusion volume of a.
bool excludes(PoissonDisk::Shape shape, const double* a, const double* b) {
  double across = 0;
  for (int axis = 0; axis < 3; ++axis) across += (a[axis] - b[axis]) * (a[axis] - b[axis]);
  const double apart = (a[3] - b[3]) * (a[3] - b[3]);
  return shape == PoissonDisk::Shape::ellipsoid ? across + apart < 1 : across < 1 && apart < 1;
}

}  // namespace

void PoissonDisk::declare_options(OptionTable& table) {
  table.add("min_horizontal_spacing", min_horizontal_spacing_km_,
            {.unit = "km",
             .maximum = 20015,
             .explanation =
                 "radius of the exclusion volume along the Earth; 0 or negative: place does not count; unset: 100, "
                 "or with min_time_spacing none"});
  table.add("min_time_spacing", min_time_spacing_,
            {.explanation = "half the length of the exclusion volume in time, such as \"PT1H\"; unset: time does not "
                            "count"});
  table.add_choice(
      "exclusion_volume_shape", shape_,
      std::vector<std::pair<std::string, Shape>>{{"cylinder", Shape::cylinder}, {"ellipsoid", Shape::ellipsoid}},
      {.explanation = "cylinder: near in place and near in time; ellipsoid: the squares of both, in units of the "
                      "spacings, add up to less than 1"});
  table.add("shuffle", shuffle_, {.explanation = "take the observations in random order; else as they come in time"});
  table.add("random_seed", random_seed_, {.explanation = "of the order: the same seed gives the same result"});
}

std::optional<ThinningMethod::Conflict> PoissonDisk::conflict() const {
  if (!min_time_spacing_) return std::nullopt;
  const auto spacing_ms = duration_ms_from_iso8601(*min_time_spacing_);
  if (spacing_ms && *spacing_ms > 0) return std::nullopt;
  return Conflict{"min_time_spacing",
                  fmt::format("must be a duration such as \"PT1H\", not \"{}\"", *min_time_spacing_)};
}

double PoissonDisk::horizontal_spacing_km() const {
  return min_horizontal_spacing_km_.value_or(min_time_spacing_ ? 0 : kSpacingWithoutAnyKm);
}

Result<Choice> PoissonDisk::choose(const ThinningInput& input) const {
  const std::int64_t spacing_ms = min_time_spacing_ ? duration_ms_from_iso8601(*min_time_spacing_).value_or(0) : 0;
  const double spacing_km = horizontal_spacing_km();
  Choice choice;
  std::vector<std::uint32_t> order = order_of(input, shuffle_, static_cast<std::uint64_t>(random_seed_));
  if (spacing_km > 0 || spacing_ms > 0) {
    const std::vector<double> places = scaled_places(input.observations, spacing_km, spacing_ms);
    const KdTree tree(places, kDimension);
    // The ball around the cylinder: its radius and half its height are 1.
    const double reach = shape_ == Shape::cylinder && spacing_km > 0 && spacing_ms > 0 ? std::numbers::sqrt2 : 1;
    std::vector<std::uint8_t> is_excluded(input.size(), 0);
    std::vector<Neighbour> found;
    for (const std::uint32_t i : order) {
      if (is_excluded[i]) continue;
      choice.retained.push_back(i);
      const double* place = places.data() + std::size_t{i} * kDimension;
      tree.radius_search({place, kDimension}, reach, found);
      for (const Neighbour& other : found)
        if (excludes(shape_, place, places.data() + std::size_t{other.index} * kDimension))
          is_excluded[other.index] = 1;
    }
  } else {
    choice.retained = std::move(order);
  }
  std::sort(choice.retained.begin(), choice.retained.end());
  return choice;
}

}  // namespace thin
