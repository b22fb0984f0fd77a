#include "libthin/estimation/variogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace thin {
namespace {

constexpr std::size_t kSample = 1500;
constexpr std::size_t kBins = 50;
constexpr double kLeastPairs = 100;

struct Bin {
  double pairs = 0, distance = 0, half_squares = 0;  // sums
};
using Bins = std::array<Bin, kBins>;

// 1 / standard deviation of each channel; 0 for one that doesn't vary.
std::vector<double> scales(std::span<const double> values, std::size_t channels) {
  const std::size_t n = values.size() / channels;
  std::vector<double> result(channels, 0.0);
  for (std::size_t c = 0; c < channels; ++c) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < n; ++i) sum += values[i * channels + c];
    for (std::size_t i = 0; i < n; ++i) squares += std::pow(values[i * channels + c] - sum / static_cast<double>(n), 2);
    result[c] = squares > 0 ? 1 / std::sqrt(squares / static_cast<double>(n)) : 0;
  }
  return result;
}

Bins empirical(const Places& places, std::span<const double> values, std::size_t channels, double max_distance_km) {
  const std::vector<double> scale = scales(values, channels);
  const auto varying = static_cast<double>(std::count_if(scale.begin(), scale.end(), [](double s) { return s > 0; }));
  const std::size_t stride = std::max<std::size_t>(1, (places.size() + kSample - 1) / kSample);
  Bins bins;
  for (std::size_t a = 0; a < places.size(); a += stride)
    for (std::size_t b = a + stride; b < places.size(); b += stride) {
      if (places.group_of(a) != places.group_of(b)) continue;
      double squared = 0;
      for (int axis = 0; axis < places.dimension; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        squared += (places.of(a)[i] - places.of(b)[i]) * (places.of(a)[i] - places.of(b)[i]);
      }
      if (squared >= max_distance_km * max_distance_km) continue;
      const double distance = std::sqrt(squared);
      double half_squares = 0;
      for (std::size_t c = 0; c < channels; ++c) {
        const double difference = (values[a * channels + c] - values[b * channels + c]) * scale[c];
        half_squares += 0.5 * difference * difference;
      }
      Bin& bin = bins[static_cast<std::size_t>(distance / max_distance_km * kBins)];
      ++bin.pairs;
      bin.distance += distance;
      bin.half_squares += varying > 0 ? half_squares / varying : 0;
    }
  return bins;
}

struct Fit {
  Variogram variogram;
  double misfit = 0;
};

// The best nugget and sill for this length: a line through the points (1 - exp(..), gamma), neither below 0.
Fit fit_with_length(const Bins& bins, double length_km) {
  double w = 0, x1 = 0, x2 = 0, y1 = 0, xy = 0;
  const auto shape = [&](const Bin& bin) {
    const double d = bin.distance / bin.pairs;
    return 1 - std::exp(-d * d / (2 * length_km * length_km));
  };
  for (const Bin& bin : bins) {
    if (bin.pairs == 0) continue;
    const double x = shape(bin), y = bin.half_squares / bin.pairs;
    w += bin.pairs, x1 += bin.pairs * x, x2 += bin.pairs * x * x, y1 += bin.pairs * y, xy += bin.pairs * x * y;
  }
  const double determinant = w * x2 - x1 * x1;
  Fit fit;
  fit.variogram.correlation_length_km = length_km;
  double sill = determinant > 0 ? (w * xy - x1 * y1) / determinant : 0;
  double nugget = (y1 - sill * x1) / w;
  if (nugget < 0) nugget = 0, sill = x2 > 0 ? xy / x2 : 0;
  if (sill < 0) sill = 0, nugget = y1 / w;
  fit.variogram.nugget = nugget;
  fit.variogram.sill = sill;
  for (const Bin& bin : bins)
    if (bin.pairs > 0) fit.misfit += bin.pairs * std::pow(nugget + sill * shape(bin) - bin.half_squares / bin.pairs, 2);
  return fit;
}

}  // namespace

std::optional<Variogram> fitted_variogram(const Places& places, std::span<const double> values, std::size_t channels,
                                          double max_distance_km) {
  if (places.size() < 3 || channels == 0) return std::nullopt;
  const Bins bins = empirical(places, values, channels, max_distance_km);
  double pairs = 0;
  for (const Bin& bin : bins) pairs += bin.pairs;
  if (pairs < kLeastPairs) return std::nullopt;
  std::optional<Fit> best;
  for (double length_km = max_distance_km / 200; length_km < max_distance_km; length_km *= 1.02) {
    const Fit fit = fit_with_length(bins, length_km);
    if (!best || fit.misfit < best->misfit) best = fit;
  }
  if (best->variogram.sill <= 0) return std::nullopt;
  return best->variogram;
}

}  // namespace thin
