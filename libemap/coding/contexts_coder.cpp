#include "libemap/coding/contexts_coder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libemap/coding/coefficient_coding.h"
#include "libemap/coding/coefficient_support.h"
#include "libemap/coding/rectangular_wavelet.h"
#include "libemap/coding/sparse_fit.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

// Where a reader puts a coefficient within its interval, measured from the interval's number.
constexpr double kReconstruction = 0.03;

QuantisedMap empty_map(const ElevationPatch& patch) {
  const std::uint32_t levels = rectangular_levels(patch.columns, patch.rows);
  return {patch.columns, patch.rows, wavelet_bands(patch.columns, patch.rows, levels),
          coefficient_support(patch.columns, patch.rows, levels, patch.mask),
          std::vector<std::int32_t>(patch.mask.size())};
}

// An error of half a step in every coefficient is one of half a step in every coarse sample, root mean square: four
// fine samples stand for a coarse one.
double step_of(const Band& band, double step) {
  return 2 * step / synthesis_norm(band);
}

template <class Function>
void for_band(const Band& band, std::uint32_t columns, const Function& function) {
  for (std::uint32_t r = band.row; r < band.row + band.rows; ++r)
    for (std::uint32_t c = band.column; c < band.column + band.columns; ++c) function(std::size_t{r} * columns + c);
}

class ContextsWriter : public ElevationWriter {
 public:
  explicit ContextsWriter(const ElevationMaps& maps) : maps_(maps) {
    for (const ElevationPatch& patch : maps.patches) quantised_.push_back(empty_map(patch));
    wanted_.resize(quantised_.size());
    fitted_.resize(quantised_.size());
  }

  void write(double step, RangeEncoder& encoder) override {
    thin::parallel_ranges(quantised_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) fit(maps_.patches[i], step, quantised_[i], wanted_[i], fitted_[i]);
    });
    CoefficientCoding coding;
    for (std::size_t i = 0; i < quantised_.size(); ++i) coding.code(encoder, quantised_[i], &wanted_[i]);
  }

 private:
  // The coefficients in steps, and what they are when rounded.
  static void fit(const ElevationPatch& patch, double step, QuantisedMap& map, std::vector<double>& wanted,
                  FittedSamples& fitted) {
    std::vector<double> known = patch.elevation;
    for (std::size_t i = 0; i < known.size(); ++i)
      if (!patch.mask[i]) known[i] = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> steps;
    for (const Band& band : map.bands) steps.push_back(step_of(band, step));
    wanted = fit_coefficients(map.columns, map.rows, rectangular_levels(map.columns, map.rows), known, map.support,
                              map.bands, steps, fitted);
    constexpr double kMost = (1U << kValueBits) - 1;
    for (std::size_t b = 0; b < map.bands.size(); ++b)
      for_band(map.bands[b], map.columns, [&](std::size_t i) {
        wanted[i] = std::clamp(wanted[i] / steps[b], -kMost, kMost);
        map.values[i] = static_cast<std::int32_t>(std::lround(wanted[i]));
      });
  }

  const ElevationMaps& maps_;
  std::vector<QuantisedMap> quantised_;
  std::vector<std::vector<double>> wanted_;  // before rounding
  std::vector<FittedSamples> fitted_;
};

void fill_in(ElevationPatch& patch, const QuantisedMap& map, double step) {
  patch.elevation.assign(map.values.size(), 0);
  for (const Band& band : map.bands) {
    const double band_step = step_of(band, step);
    const double offset = band.kind == 0 ? 0 : kReconstruction;
    for_band(band, map.columns, [&](std::size_t i) {
      const double value = map.values[i];
      if (value != 0) patch.elevation[i] = band_step * std::copysign(std::abs(value) + offset, value);
    });
  }
  rectangular_synthesis(map.columns, map.rows, rectangular_levels(map.columns, map.rows), patch.elevation);
  for (std::size_t i = 0; i < patch.mask.size(); ++i)
    if (!patch.mask[i]) patch.elevation[i] = 0;
}

thin::Result<void> read(RangeDecoder& decoder, double step, ElevationMaps& maps) {
  CoefficientCoding coding;
  std::vector<QuantisedMap> quantised;
  for (const ElevationPatch& patch : maps.patches) {
    quantised.push_back(empty_map(patch));
    coding.code(decoder, quantised.back());
    if (decoder.exhausted())
      return thin::Error{thin::ErrorKind::incomplete,
                         "the stream ends within the elevations: it was cut or is damaged"};
  }
  thin::parallel_ranges(quantised.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) fill_in(maps.patches[i], quantised[i], step);
  });
  return {};
}

}  // namespace

ElevationCoder contexts_coder() {
  return {2,
          "contexts",
          "13/7 wavelet on rectangles with its finest band left out, mixed contexts",
          true,
          [](const ElevationMaps& maps, BitDistribution) -> std::unique_ptr<ElevationWriter> {
            return std::make_unique<ContextsWriter>(maps);
          },
          &read};
}

}  // namespace emap
