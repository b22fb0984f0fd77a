#include "libthin/analysis/synthetic_climatology.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Continent {
  double latitude_deg, longitude_deg;      // centre
  double half_height_deg, half_width_deg;  // of the ellipse in latitude and longitude
};
constexpr Continent kContinents[] = {
    {15, 17, 20, 32},  {-12, 25, 24, 14},  {52, 25, 13, 30},   {50, 90, 24, 52},  {20, 78, 14, 8},
    {22, 105, 14, 13}, {24, 47, 11, 11},   {51, -100, 21, 32}, {22, -102, 9, 7},  {-10, -60, 18, 18},
    {-37, -67, 19, 7}, {-25, 134, 12, 19}, {72, -41, 11, 14},  {-90, 0, 19, 1e9},
};
constexpr double kCoastWidthKm = 100;

// Means at the equator and at the poles, K.
struct ChannelClimate {
  double sea_equator, sea_pole, land_equator, land_pole;
};
constexpr ChannelClimate kClimate[kSyntheticChannels] = {
    {220, 165, 280, 230}, {190, 155, 280, 230}, {245, 215, 285, 235}, {273, 240, 278, 238}, {263, 234, 263, 234},
    {244, 224, 244, 224}, {231, 221, 231, 221}, {219, 222, 219, 222}, {205, 219, 205, 219}, {207, 221, 207, 221},
    {216, 225, 216, 225}, {227, 232, 227, 232}, {239, 241, 239, 241}, {250, 252, 250, 252}, {265, 210, 287, 225},
};

// At the edge of the swath, K.
constexpr double kEdgeZenithDeg = 57.6;
constexpr ChannelValues kLimbAtEdgeK = {12, 10, 8, -1, -7, -7, -5, -3, 1, 3, 3, 3, 3, 2.5, 9};

// The warmest latitude follows the Sun, a third of its way and a month behind: 8 degrees north in late July.
double thermal_equator_deg(std::int64_t time_ms) {
  constexpr double kYearMs = 365.2425 * 86'400'000;
  constexpr double kDayOfWarmingPastEquator = 111;
  const double year = static_cast<double>(time_ms) / kYearMs - kDayOfWarmingPastEquator / 365.2425;
  return 8 * std::sin(2 * std::numbers::pi * year);
}

}  // namespace

double land_fraction(double latitude_deg, double longitude_deg) {
  double land = 0;
  for (const Continent& c : kContinents) {
    const double north = (latitude_deg - c.latitude_deg) / c.half_height_deg;
    const double east = normalised_longitude_deg(longitude_deg - c.longitude_deg) / c.half_width_deg;
    const double inside = 1 - std::hypot(north, east);
    const double inside_km = inside * std::min(c.half_height_deg, c.half_width_deg) * kDegree * kEarthRadiusKm;
    land = std::max(land, 0.5 + 0.5 * std::tanh(inside_km / kCoastWidthKm));
  }
  return land;
}

ChannelValues climatology_k(double latitude_deg, double longitude_deg, std::int64_t time_ms) {
  // 1 where it is warmest, 0 at the far pole.
  const double warmth = 0.5 + 0.5 * std::cos(2 * (latitude_deg - thermal_equator_deg(time_ms)) * kDegree);
  const double land = land_fraction(latitude_deg, longitude_deg);
  ChannelValues mean_k{};
  for (std::size_t channel = 0; channel < mean_k.size(); ++channel) {
    const ChannelClimate& climate = kClimate[channel];
    const double sea_k = std::lerp(climate.sea_pole, climate.sea_equator, warmth);
    const double land_k = std::lerp(climate.land_pole, climate.land_equator, warmth);
    mean_k[channel] = std::lerp(sea_k, land_k, land);
  }
  return mean_k;
}

ChannelValues limb_effect_k(double satellite_zenith_deg) {
  assert(satellite_zenith_deg >= 0 && satellite_zenith_deg < 80);
  const double longer_path = 1 / std::cos(satellite_zenith_deg * kDegree) - 1;
  const double at_edge = 1 / std::cos(kEdgeZenithDeg * kDegree) - 1;
  ChannelValues effect_k = kLimbAtEdgeK;
  for (double& effect : effect_k) effect *= longer_path / at_edge;
  return effect_k;
}

}  // namespace thin
