#include "libemap/coding/contexts_coder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libemap/coding/coefficient_coding.h"
#include "libemap/coding/coefficient_support.h"
#include "libemap/coding/quantisation.h"
#include "libemap/coding/rectangular_wavelet.h"
#include "libemap/coding/sparse_fit.h"
#include "libemap/coding/value_choice.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr double kRounding = 0.35;  // of magnitudes, before they are chosen one by one
constexpr int kSweeps = 3;

class ContextsWriter : public ElevationWriter {
 public:
  explicit ContextsWriter(const ElevationMaps& maps) : maps_(maps) {
    for (const ElevationPatch& patch : maps.patches) {
      quantised_.push_back(quantised_map(patch.columns, patch.rows, patch.mask));
      choices_.emplace_back(patch, quantised_.back());
    }
    fitted_.resize(quantised_.size());
  }

  void write(double step, RangeEncoder& encoder) override {
    for_maps([&](std::size_t i) { fit(maps_.patches[i], step, quantised_[i], fitted_[i]); });
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      MagnitudeCosts costs;
      for (const QuantisedMap& map : quantised_) costs.count(map);
      costs.finish();
      for_maps([&](std::size_t i) { choices_[i].sweep(costs, step, quantised_[i]); });
    }
    CoefficientCoding coding;
    for (QuantisedMap& map : quantised_) coding.code(encoder, map);
  }

 private:
  template <class Function>
  void for_maps(const Function& function) const {
    thin::parallel_ranges(quantised_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) function(i);
    });
  }

  // The coefficients in steps, rounded.
  static void fit(const ElevationPatch& patch, double step, QuantisedMap& map, FittedSamples& fitted) {
    std::vector<double> known = patch.elevation;
    for (std::size_t i = 0; i < known.size(); ++i)
      if (!patch.mask[i]) known[i] = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> steps;
    for (const Band& band : map.bands) steps.push_back(step_of_band(band, step));
    const std::vector<double> wanted = fit_coefficients(
        map.columns, map.rows, rectangular_levels(map.columns, map.rows), known, map.support, map.bands, steps, fitted);
    constexpr double kMost = (1U << kValueBits) - 1;
    for (std::size_t b = 0; b < map.bands.size(); ++b)
      for_band(map.bands[b], map.columns, [&](std::size_t i) {
        const double magnitude = std::min(std::abs(wanted[i]) / steps[b], kMost);
        const auto rounded = static_cast<std::int32_t>(magnitude + (map.bands[b].kind == 0 ? 0.5 : kRounding));
        map.values[i] = wanted[i] < 0 ? -rounded : rounded;
      });
  }

  const ElevationMaps& maps_;
  std::vector<QuantisedMap> quantised_;
  std::vector<ValueChoice> choices_;
  std::vector<FittedSamples> fitted_;
};

void fill_in(ElevationPatch& patch, const QuantisedMap& map, double step) {
  patch.elevation.assign(map.values.size(), 0);
  for (const Band& band : map.bands) {
    const double band_step = step_of_band(band, step);
    for_band(band, map.columns,
             [&](std::size_t i) { patch.elevation[i] = band_step * reconstructed(map.values[i], band.kind); });
  }
  rectangular_synthesis(map.columns, map.rows, rectangular_levels(map.columns, map.rows), patch.elevation);
  for (std::size_t i = 0; i < patch.mask.size(); ++i)
    if (!patch.mask[i]) patch.elevation[i] = 0;
}

thin::Result<void> read(RangeDecoder& decoder, double step, ElevationMaps& maps) {
  CoefficientCoding coding;
  std::vector<QuantisedMap> quantised;
  for (const ElevationPatch& patch : maps.patches) {
    quantised.push_back(quantised_map(patch.columns, patch.rows, patch.mask));
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
