#include "libemap/coding/sparse_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "libemap/coding/rectangular_wavelet.h"

namespace emap {
namespace {

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

// Unknown samples become the mean of the known ones in the smallest aligned square that has any.
std::vector<double> filled(std::uint32_t columns, std::uint32_t rows, const std::vector<double>& samples) {
  std::vector<Pyramid> levels = {{columns, rows, samples, std::vector<double>(samples.size(), 1)}};
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (std::isnan(samples[i])) levels[0].sums[i] = levels[0].weights[i] = 0;
  while (levels.back().columns > 1 || levels.back().rows > 1) levels.push_back(half_of(levels.back()));
  for (std::size_t l = levels.size(); l-- > 1;) {
    const Pyramid& coarse = levels[l];
    Pyramid& fine = levels[l - 1];
    for (std::uint32_t r = 0; r < fine.rows; ++r)
      for (std::uint32_t c = 0; c < fine.columns; ++c) {
        const std::size_t to = std::size_t{r} * fine.columns + c, from = std::size_t{r / 2} * coarse.columns + c / 2;
        if (fine.weights[to] > 0 || coarse.weights[from] == 0) continue;
        fine.sums[to] = coarse.sums[from] / coarse.weights[from];
        fine.weights[to] = 1;
      }
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
                                     const FitOptions& options) {
  assert(samples.size() == std::size_t{columns} * rows && support.size() == samples.size());
  if (samples.empty()) return {};
  std::vector<double> image = filled(columns, rows, samples);
  std::vector<double> coefficients;
  const double fall = std::pow(options.last_threshold / options.first_threshold, 1.0 / (options.rounds - 1));
  double factor = options.first_threshold;
  for (int round = 0; round < options.rounds; ++round, factor *= fall) {
    coefficients = image;
    rectangular_analysis(columns, rows, levels, coefficients);
    const bool last = round + 1 == options.rounds;
    threshold(bands, steps, last ? 0 : factor, support, columns, coefficients);
    if (last) break;
    image = coefficients;
    rectangular_synthesis(columns, rows, levels, image);
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (!std::isnan(samples[i])) image[i] = samples[i];
  }
  return coefficients;
}

}  // namespace emap
