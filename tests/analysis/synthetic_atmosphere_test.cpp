#include "libthin/analysis/synthetic_atmosphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "libthin/foundation/parallel.h"
#include "libthin/observations/geodesy.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

const std::int64_t kTime = from_iso8601("2004-07-21T22:30Z").value();

// Points spread evenly over the Earth (Fibonacci's lattice).
std::vector<Vector3> places(int count) {
  std::vector<Vector3> places_km;
  for (int i = 0; i < count; ++i) {
    const double latitude_deg = std::asin(1 - (2 * i + 1.0) / count) * 180 / std::acos(-1.0);
    places_km.push_back(geocentric_km(latitude_deg, 137.50776405 * i));
  }
  return places_km;
}

// The place `distance_km` further east or, near the poles too, along a meridian circle of the y axis.
Vector3 beside(const Vector3& p, double distance_km) {
  const double angle = distance_km / std::hypot(p.x, p.z);
  return {std::cos(angle) * p.x + std::sin(angle) * p.z, p.y, std::cos(angle) * p.z - std::sin(angle) * p.x};
}

std::size_t at(int channel) {
  return static_cast<std::size_t>(channel - 1);
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) ab += a[i] * b[i], aa += a[i] * a[i], bb += b[i] * b[i];
  return ab / std::sqrt(aa * bb);
}

TEST(SyntheticAtmosphere, SeedAlonePicksTheWeather) {
  const SyntheticAtmosphere one(1), again(1), other(2);
  int differing = 0;
  for (const Vector3& p : places(200)) {
    EXPECT_EQ(one.anomaly_k(p, kTime), again.anomaly_k(p, kTime));
    differing += one.anomaly_k(p, kTime) != other.anomaly_k(p, kTime);
  }
  EXPECT_GT(differing, 150);
  EXPECT_EQ(one.noise_k({206, kTime, 3}), again.noise_k({206, kTime, 3}));
  EXPECT_NE(one.noise_k({206, kTime, 3}), other.noise_k({206, kTime, 3}));
}

TEST(SyntheticAtmosphere, OrderAndThreadsChangeNothing) {
  const SyntheticAtmosphere atmosphere(7);
  const Orbit orbit(*find_orbit("NOAA-15"));
  constexpr std::size_t kLines = 60;
  const auto measure = [&](std::size_t line, std::vector<ChannelValues>& values) {
    const std::int64_t line_ms = kTime + static_cast<std::int64_t>(line) * kAmsuaLineMs;
    const auto views = amsua_scan_line(orbit, line_ms);
    for (std::size_t f = 0; f < views.size(); ++f)
      values[line * views.size() + f] =
          atmosphere.measurement_k(views[f], {206, line_ms, static_cast<std::int32_t>(f + 1)}, {});
  };
  std::vector<ChannelValues> backwards(kLines * kAmsuaFieldsOfView);
  for (std::size_t line = kLines; line-- > 0;) measure(line, backwards);
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    std::vector<ChannelValues> values(backwards.size());
    parallel_ranges(kLines, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t line = begin; line < end; ++line) measure(line, values);
    });
    EXPECT_EQ(values, backwards);
  }
}

TEST(SyntheticAtmosphere, NoiseIsWhiteAndOfTheInstrumentsSize) {
  const SyntheticAtmosphere atmosphere(1);
  std::vector<std::vector<double>> noise(kSyntheticChannels);
  std::vector<double> next_field_of_view, next_line, other_satellite;
  for (int line = 0; line < 1000; ++line)
    for (int f = 1; f <= kAmsuaFieldsOfView; ++f) {
      const std::int64_t line_ms = kTime + line * kAmsuaLineMs;
      const ChannelValues values = atmosphere.noise_k({206, line_ms, f});
      for (std::size_t c = 0; c < values.size(); ++c) noise[c].push_back(values[c] / kNoiseDeviationK[c]);
      next_field_of_view.push_back(atmosphere.noise_k({206, line_ms, f + 1})[0]);
      next_line.push_back(atmosphere.noise_k({206, line_ms + kAmsuaLineMs, f})[0]);
      other_satellite.push_back(atmosphere.noise_k({207, line_ms, f})[0]);
    }
  for (const auto& channel : noise) {
    double mean = 0, square = 0, fourth = 0;
    for (const double x : channel) mean += x, square += x * x, fourth += x * x * x * x;
    const auto n = static_cast<double>(channel.size());
    EXPECT_NEAR(mean / n, 0, 0.03);
    EXPECT_NEAR(square / n, 1, 0.04);
    EXPECT_NEAR(fourth / n, 3, 0.3);  // of a normal distribution
  }
  EXPECT_NEAR(correlation(noise[0], noise[1]), 0, 0.03);
  EXPECT_NEAR(correlation(noise[0], next_field_of_view), 0, 0.03);
  EXPECT_NEAR(correlation(noise[0], next_line), 0, 0.03);
  EXPECT_NEAR(correlation(noise[0], other_satellite), 0, 0.03);
}

TEST(SyntheticAtmosphere, MeasurementIsTruthPlusLimbEffectPlusNoise) {
  const SyntheticAtmosphere atmosphere(3);
  const Orbit orbit(*find_orbit("NOAA-16"));
  const FieldOfView view = amsua_scan_line(orbit, kTime)[4];
  const MeasurementKey key{207, kTime, 5};
  const ChannelValues truth = atmosphere.truth_k(view.latitude_deg, view.longitude_deg, view.time_ms);
  const ChannelValues mean = climatology_k(view.latitude_deg, view.longitude_deg, view.time_ms);
  const ChannelValues anomaly =
      atmosphere.anomaly_k(geocentric_km(view.latitude_deg, view.longitude_deg), view.time_ms);
  const ChannelValues limb = limb_effect_k(view.satellite_zenith_deg), noise = atmosphere.noise_k(key);
  for (std::size_t c = 0; c < truth.size(); ++c) {
    EXPECT_NEAR(truth[c], mean[c] + anomaly[c], 1e-9);
    EXPECT_NEAR(atmosphere.measurement_k(view, key, {})[c], truth[c] + limb[c] + noise[c], 1e-9);
    EXPECT_NEAR(atmosphere.measurement_k(view, key, {.noise = false})[c], truth[c] + limb[c], 1e-9);
    EXPECT_NEAR(atmosphere.measurement_k(view, key, {.climatology = false})[c], kFlatMeanK + anomaly[c] + noise[c],
                1e-9);
  }
}

TEST(SyntheticAtmosphere, FlatRegionsAreFlatAndTheOthersAreNot) {
  double flat = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const SyntheticAtmosphere atmosphere(seed);
    double busy_squares = 0, busy = 0;
    for (const Vector3& p : places(1500)) {
      const double channel_5 = atmosphere.anomaly_k(p, kTime)[at(5)];
      ++all;
      if (atmosphere.is_flat(p, kTime)) {
        ++flat;
        EXPECT_LT(std::abs(channel_5), 0.1);
      } else {
        ++busy;
        busy_squares += channel_5 * channel_5;
      }
    }
    EXPECT_GT(std::sqrt(busy_squares / busy), 0.5) << "seed " << seed;
  }
  EXPECT_GT(flat / all, 0.2);
  EXPECT_LT(flat / all, 0.5);
}

TEST(SyntheticAtmosphere, VariesMoreOverLongerDistances) {
  const SyntheticAtmosphere atmosphere(5);
  const std::vector<Vector3> here = places(4000);
  double before = 0;
  for (const double distance_km : {25.0, 100.0, 400.0}) {
    double squares = 0;
    for (const Vector3& p : here) {
      const double change =
          atmosphere.anomaly_k(beside(p, distance_km), kTime)[at(6)] - atmosphere.anomaly_k(p, kTime)[at(6)];
      squares += change * change;
    }
    const double typical = std::sqrt(squares / static_cast<double>(here.size()));
    EXPECT_GT(typical, 1.7 * before) << distance_km;
    before = typical;
  }
}

TEST(SyntheticAtmosphere, FrontsAreSharpButResolved) {
  // Along a fine track round the Earth at 45 degrees: somewhere channel 5 jumps by more than 1.5 K within 100 km;
  // nowhere by more than the strongest front's slope allows.
  double steepest_k_per_km = 0, largest_jump_k = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SyntheticAtmosphere atmosphere(seed);
    for (const double latitude_deg : {-50.0, -40.0, 40.0, 50.0}) {
      std::vector<double> track;
      for (double longitude_deg = 0; longitude_deg < 360; longitude_deg += 0.125)  // about 10 km
        track.push_back(atmosphere.anomaly_k(geocentric_km(latitude_deg, longitude_deg), kTime)[at(5)]);
      for (std::size_t i = 10; i < track.size(); ++i) {
        steepest_k_per_km = std::max(steepest_k_per_km, std::abs(track[i] - track[i - 1]) / 10);
        largest_jump_k = std::max(largest_jump_k, std::abs(track[i] - track[i - 10]));
      }
    }
  }
  EXPECT_GT(largest_jump_k, 1.5);
  EXPECT_LT(steepest_k_per_km, 0.3);
}

TEST(SyntheticAtmosphere, NeighbouringChannelsSeeMuchTheSame) {
  const SyntheticAtmosphere atmosphere(5);
  std::vector<std::vector<double>> channel(kSyntheticChannels);
  for (const Vector3& p : places(5000)) {
    const ChannelValues values = atmosphere.anomaly_k(p, kTime);
    for (std::size_t c = 0; c < values.size(); ++c) channel[c].push_back(values[c]);
  }
  EXPECT_GT(correlation(channel[at(5)], channel[at(6)]), 0.6);
  EXPECT_GT(correlation(channel[at(12)], channel[at(13)]), 0.5);
  EXPECT_LT(std::abs(correlation(channel[at(5)], channel[at(13)])), 0.3);
}

TEST(SyntheticAtmosphere, ChangesSlowlyInTime) {
  const SyntheticAtmosphere atmosphere(5);
  double hour = 0, day = 0, size = 0;
  for (const Vector3& p : places(2000)) {
    const double now = atmosphere.anomaly_k(p, kTime)[at(6)];
    size += now * now;
    hour += std::pow(atmosphere.anomaly_k(p, kTime + 3'600'000)[at(6)] - now, 2);
    day += std::pow(atmosphere.anomaly_k(p, kTime + 2 * 86'400'000)[at(6)] - now, 2);
  }
  EXPECT_GT(hour, 0);
  EXPECT_LT(hour, 0.05 * size);
  EXPECT_GT(day, 0.3 * size);
}

}  // namespace
}  // namespace thin
