#include "libemap/coding/sparse_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "libemap/coding/rectangular_wavelet.h"

namespace emap {
namespace {

constexpr int kRelaxations = 4;

struct Pyramid {
  std::uint32_t columns, rows;
  std::vector<double> sums, weights;
};

Pyramid half_of(const Pyramid& fine) {
  Pyramid half{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}, {}};
  half.sums.resize(std::size_t{half.columns} * half.rows);
  half.weights.resize(half.sums.size());
  for (std::uint32_t r = 0; r < fine.rows; ++r)
    for (std::uint32_t c = 0; c < fine.columns; ++c) {
      const std::size_t from = std::size_t{r} * fine.columns + c, to = std::size_t{r / 2} * half.columns + c / 2;
      half.sums[to] += fine.sums[from];
      half.weights[to] += fine.weights[from];
    }
  return half;
}

// Each unknown sample becomes the mean of its neighbours, in place.
void relax(Pyramid& level, const std::vector<std::size_t>& unknown) {
  for (const std::size_t place : unknown) {
    const std::size_t row = place / level.columns, column = place % level.columns;
    double sum = 0;
    int count = 0;
    const auto add = [&](std::size_t neighbour) {
      sum += level.sums[neighbour] / level.weights[neighbour];
      ++count;
    };
    if (column > 0) add(place - 1);
    if (column + 1 < level.columns) add(place + 1);
    if (row > 0) add(place - level.columns);
    if (row + 1 < level.rows) add(place + level.columns);
    if (count > 0) level.sums[place] = sum / count;
  }
}

// Unknown samples go on smoothly from the known ones: from coarse squares to fine ones, the mean of what is known in a
// square where anything is, else that of the square around it, relaxed.
std::vector<double> filled(std::uint32_t columns, std::uint32_t rows, const std::vector<double>& samples) {
  std::vector<Pyramid> levels = {{columns, rows, samples, std::vector<double>(samples.size(), 1)}};
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (std::isnan(samples[i])) levels[0].sums[i] = levels[0].weights[i] = 0;
  while (levels.back().columns > 1 || levels.back().rows > 1) levels.push_back(half_of(levels.back()));
  if (levels.back().weights[0] == 0) return levels[0].sums;
  for (std::size_t l = levels.size(); l-- > 1;) {
    const Pyramid& coarse = levels[l];
    Pyramid& fine = levels[l - 1];
    std::vector<std::size_t> unknown;
    for (std::uint32_t r = 0; r < fine.rows; ++r)
      for (std::uint32_t c = 0; c < fine.columns; ++c) {
        const std::size_t to = std::size_t{r} * fine.columns + c, from = std::size_t{r / 2} * coarse.columns + c / 2;
        if (fine.weights[to] > 0) continue;
        fine.sums[to] = coarse.sums[from] / coarse.weights[from];
        fine.weights[to] = 1;
        unknown.push_back(to);
      }
    for (int round = 0; round < kRelaxations; ++round) relax(fine, unknown);
  }
  return levels[0].sums;
}

void threshold(const std::vector<Band>& bands, const std::vector<double>& steps, double factor,
               const std::vector<std::uint8_t>& support, std::uint32_t columns, std::vector<double>& coefficients) {
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const Band& band = bands[b];
    const double least = band.kind == 0 ? 0 : factor * steps[b];
    for (std::uint32_t r = band.row; r < band.row + band.rows; ++r)
      for (std::uint32_t c = band.column; c < band.column + band.columns; ++c) {
        double& coefficient = coefficients[std::size_t{r} * columns + c];
        if (!support[std::size_t{r} * columns + c] || std::abs(coefficient) < least) coefficient = 0;
      }
  }
}

}  // namespace

std::vector<double> fit_coefficients(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                                     const std::vector<double>& samples, const std::vector<std::uint8_t>& support,
                                     const std::vector<Band>& bands, const std::vector<double>& steps,
                                     FittedSamples& fitted, const FitOptions& options) {
  assert(samples.size() == std::size_t{columns} * rows && support.size() == samples.size());
  if (samples.empty()) return {};
  const bool first = fitted.empty();
  if (first) fitted = filled(columns, rows, samples);
  const int rounds = first ? options.rounds : options.further_rounds;
  double factor = first ? options.first_threshold : options.further_threshold;
  const double fall = std::pow(options.last_threshold / factor, 1.0 / (rounds - 1));
  std::vector<double> coefficients, image, last_image;
  for (int round = 1; round < rounds; ++round, factor *= fall) {
    coefficients = fitted;
    rectangular_analysis(columns, rows, levels, coefficients);
    threshold(bands, steps, factor, support, columns, coefficients);
    image = std::move(coefficients);
    rectangular_synthesis(columns, rows, levels, image);
    const double momentum = last_image.empty() ? 0 : options.momentum;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!std::isnan(samples[i])) continue;
      fitted[i] = image[i];
      if (momentum > 0) fitted[i] += momentum * (image[i] - last_image[i]);
    }
    last_image.swap(image);
  }
  coefficients = fitted;
  rectangular_analysis(columns, rows, levels, coefficients);
  threshold(bands, steps, 0, support, columns, coefficients);
  return coefficients;
}

}  // namespace emap
