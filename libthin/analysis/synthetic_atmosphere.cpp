#include "libthin/analysis/synthetic_atmosphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kDegree = std::numbers::pi / 180;

// The pattern drifts eastward as a whole, and each wave a little by itself.
constexpr double kDriftRadPerS = 0.012 / kEarthRadiusKm;
constexpr double kWaveSpeedKmPerS = 0.005;

constexpr int kWavesPerHeight = 40;
constexpr int kWavesOfRegions = 12;
constexpr int kFronts = 16;
constexpr double kFrontHalfLengthKm = 1500;
constexpr double kFrontReachKm = 600;

// Heights of the independent patterns, and of the channels' weighting functions, in scale heights ln(1000 hPa / p).
constexpr double kPatternHeights[] = {0, 0.8, 1.7, 2.7, 3.8, 5.2};
constexpr std::size_t kPatterns = std::size(kPatternHeights);
constexpr ChannelValues kChannelHeight = {0, 0, 0.05, 0.1, 0.4, 0.9, 1.4, 1.8, 2.4, 3.0, 3.7, 4.4, 5.3, 6.0, 0.1};
constexpr double kHeightOverlap = 0.8;

constexpr ChannelValues kWaveDeviationK = {5, 4, 3, 2, 1.8, 1.6, 1.4, 1.3, 1.2, 1.2, 1.4, 1.8, 2, 2.5, 5};
// Half the jump across the strongest front. Above the tropopause (channel 8) the contrast turns round.
constexpr ChannelValues kFrontJumpK = {8, 6, 5, 3, 3, 2.5, 2, -1.5, -2, -1.5, -1, -0.5, 0.3, 0.3, 8};

// splitmix64: Steele, Lea and Flood 2014. Also the hash from which the noise comes.
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}
std::uint64_t next(std::uint64_t& state) {
  return mix(state += 0x9e3779b97f4a7c15U);
}

// Uniform in (0, 1): never 0, so that its logarithm exists.
double unit_interval(std::uint64_t bits) {
  return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}
double uniform(std::uint64_t& state, double low, double high) {
  return low + (high - low) * unit_interval(next(state));
}

// Box and Muller.
double normal(std::uint64_t bits_a, std::uint64_t bits_b) {
  return std::sqrt(-2 * std::log(unit_interval(bits_a))) * std::cos(kTurn * unit_interval(bits_b));
}

double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vector3 scaled(double s, const Vector3& v) {
  return {s * v.x, s * v.y, s * v.z};
}

Vector3 random_direction(std::uint64_t& random) {
  const double z = uniform(random, -1, 1);
  const double longitude = uniform(random, 0, kTurn);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(longitude), r * std::sin(longitude), z};
}

// The place in a frame that drifts with the pattern.
Vector3 drifting(const Vector3& p, double time_s) {
  const double angle = std::remainder(kDriftRadPerS * time_s, kTurn);
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x + s * p.y, c * p.y - s * p.x, p.z};
}

// Since 2000, so that phases stay small.
double pattern_time_s(std::int64_t time_ms) {
  return static_cast<double>(time_ms - 946'684'800'000) / 1000;
}

// Share of each pattern in each channel: neighbouring channels see much the same, distant ones nothing in common.
std::array<std::array<double, kPatterns>, kSyntheticChannels> pattern_shares() {
  std::array<std::array<double, kPatterns>, kSyntheticChannels> shares{};
  for (std::size_t channel = 0; channel < kSyntheticChannels; ++channel) {
    double squares = 0;
    for (std::size_t pattern = 0; pattern < kPatterns; ++pattern) {
      const double distance = (kChannelHeight[channel] - kPatternHeights[pattern]) / kHeightOverlap;
      shares[channel][pattern] = std::exp(-0.5 * distance * distance);
      squares += shares[channel][pattern] * shares[channel][pattern];
    }
    for (double& share : shares[channel]) share *= kWaveDeviationK[channel] / std::sqrt(squares);
  }
  return shares;
}

}  // namespace

SyntheticAtmosphere::SyntheticAtmosphere(std::uint64_t seed) : seed_(mix(seed + 1)) {
  std::uint64_t random = seed_;
  for (std::size_t i = 0; i < kPatterns; ++i) heights_.push_back(make_waves(random, kWavesPerHeight, 200, 4000));
  regions_ = make_waves(random, kWavesOfRegions, 4000, 8000);
  for (int i = 0; i < kFronts; ++i) fronts_.push_back(make_front(random));
}

// Lengths are spread evenly in their logarithm; there a variance of wave number^-3 means an amplitude that grows with
// the length.
SyntheticAtmosphere::Waves SyntheticAtmosphere::make_waves(std::uint64_t& random, int count, double shortest_km,
                                                           double longest_km) {
  Waves waves;
  double variance = 0;
  for (int i = 0; i < count; ++i) {
    const double length_km = shortest_km * std::pow(longest_km / shortest_km, (i + uniform(random, 0, 1)) / count);
    const double wave_number = kTurn / length_km;
    const Vector3 direction = random_direction(random);
    const double phase = uniform(random, 0, kTurn);
    const double rate = wave_number * uniform(random, -kWaveSpeedKmPerS, kWaveSpeedKmPerS);
    waves.push_back({scaled(wave_number, direction), phase, rate, length_km});
    variance += 0.5 * length_km * length_km;
  }
  for (Wave& wave : waves) wave.amplitude /= std::sqrt(variance);
  return waves;
}

SyntheticAtmosphere::Front SyntheticAtmosphere::make_front(std::uint64_t& random) {
  const double hemisphere = next(random) & 1U ? 1 : -1;
  const double latitude = hemisphere * uniform(random, 30, 60) * kDegree;
  const double longitude = uniform(random, 0, kTurn);
  const double cp = std::cos(latitude), sp = std::sin(latitude);
  const double cl = std::cos(longitude), sl = std::sin(longitude);
  const Vector3 centre{cp * cl, cp * sl, sp}, east{-sl, cl, 0}, north{-sp * cl, -sp * sl, cp};

  const double turn = uniform(random, 0, kTurn);
  const double c = std::cos(turn), s = std::sin(turn);
  Front front;
  front.centre = centre;
  front.along = {c * east.x + s * north.x, c * east.y + s * north.y, s * north.z};
  front.across = {c * north.x - s * east.x, c * north.y - s * east.y, c * north.z};
  front.half_width_km = uniform(random, 25, 50);
  front.bend_km = uniform(random, 150, 400);
  front.strength = (next(random) & 1U ? 1 : -1) * uniform(random, 0.5, 1);
  return front;
}

double SyntheticAtmosphere::sum(const Waves& waves, const Vector3& position_km, double time_s) {
  double total = 0;
  for (const Wave& wave : waves)
    total += wave.amplitude *
             std::cos(dot(wave.wave_vector_per_km, position_km) - wave.rate_rad_per_s * time_s + wave.phase_rad);
  return total;
}

// Where a place lies in the front's own, bent coordinates. The line waves about its great circle.
SyntheticAtmosphere::FrontPlace SyntheticAtmosphere::place_at(const Front& front, const Vector3& position_km) {
  const double inward = dot(front.centre, position_km);
  if (inward < 0.7 * kEarthRadiusKm) return {0, 0};  // beyond 5,000 km nothing is left of any front
  const double along_km = kEarthRadiusKm * std::atan2(dot(front.along, position_km), inward);
  const double from_great_circle_km = kEarthRadiusKm * std::atan2(dot(front.across, position_km), inward);
  const double across_km = from_great_circle_km - front.bend_km * std::sin(along_km / 500);
  const double a = along_km / kFrontHalfLengthKm;
  const double b = across_km / kFrontReachKm;
  return {across_km, front.strength * std::exp(-a * a * a * a - b * b)};
}

// A step across the line.
double SyntheticAtmosphere::jump(const Front& front, const Vector3& position_km) {
  const FrontPlace place = place_at(front, position_km);
  return place.strength * std::tanh(place.across_km / front.half_width_km);
}

// 0 in the flat regions, 1 in the busy ones.
double SyntheticAtmosphere::activity(const Vector3& drifting_km, double time_s) const {
  const double x = std::clamp((sum(regions_, drifting_km, time_s) + 0.25) / 0.75, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

ChannelValues SyntheticAtmosphere::anomaly_k(const Vector3& position_km, std::int64_t time_ms) const {
  static const auto shares = pattern_shares();
  const double time_s = pattern_time_s(time_ms);
  const Vector3 place_km = drifting(position_km, time_s);

  std::array<double, kPatterns> pattern{};
  if (const double active = activity(place_km, time_s); active > 0)
    for (std::size_t i = 0; i < kPatterns; ++i) pattern[i] = active * sum(heights_[i], place_km, time_s);
  double jumps = 0;
  for (const Front& front : fronts_) jumps += jump(front, place_km);

  ChannelValues anomaly_k{};
  for (std::size_t channel = 0; channel < anomaly_k.size(); ++channel) {
    anomaly_k[channel] = kFrontJumpK[channel] * jumps;
    for (std::size_t i = 0; i < kPatterns; ++i) anomaly_k[channel] += shares[channel][i] * pattern[i];
  }
  return anomaly_k;
}

ChannelValues SyntheticAtmosphere::truth_k(double latitude_deg, double longitude_deg, std::int64_t time_ms) const {
  ChannelValues truth_k = climatology_k(latitude_deg, longitude_deg, time_ms);
  const ChannelValues anomaly = anomaly_k(geocentric_km(latitude_deg, longitude_deg), time_ms);
  for (std::size_t channel = 0; channel < truth_k.size(); ++channel) truth_k[channel] += anomaly[channel];
  return truth_k;
}

ChannelValues SyntheticAtmosphere::measurement_k(const FieldOfView& view, const MeasurementKey& key,
                                                 const MeasurementOptions& options) const {
  ChannelValues measured_k = anomaly_k(geocentric_km(view.latitude_deg, view.longitude_deg), view.time_ms);
  const auto add = [&](const ChannelValues& part) {
    for (std::size_t channel = 0; channel < measured_k.size(); ++channel) measured_k[channel] += part[channel];
  };
  if (options.climatology) {
    add(climatology_k(view.latitude_deg, view.longitude_deg, view.time_ms));
    add(limb_effect_k(view.satellite_zenith_deg));
  } else {
    for (double& value : measured_k) value += kFlatMeanK;
  }
  if (options.noise) add(noise_k(key));
  return measured_k;
}

ChannelValues SyntheticAtmosphere::noise_k(const MeasurementKey& key) const {
  std::uint64_t hash = seed_;
  for (const std::int64_t part : {std::int64_t{key.platform}, key.line_begin_ms, std::int64_t{key.field_of_view}})
    hash = mix(hash ^ mix(static_cast<std::uint64_t>(part) + 0x9e3779b97f4a7c15U));
  ChannelValues noise_k = kNoiseDeviationK;
  for (double& noise : noise_k) {
    const std::uint64_t first = next(hash);
    noise *= normal(first, next(hash));
  }
  return noise_k;
}

bool SyntheticAtmosphere::is_flat(const Vector3& position_km, std::int64_t time_ms) const {
  const double time_s = pattern_time_s(time_ms);
  const Vector3 place_km = drifting(position_km, time_s);
  if (activity(place_km, time_s) > 0) return false;
  return std::all_of(fronts_.begin(), fronts_.end(),
                     [&](const Front& front) { return std::abs(place_at(front, place_km).strength) < 0.01; });
}

}  // namespace thin
