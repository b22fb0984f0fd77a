#include "libemap/coding/baseline_coder.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "libemap/coding/map_slope.h"
#include "libemap/coding/plane_coding.h"
#include "libemap/coding/set_splitting.h"
#include "libemap/coding/shape_adaptive_wavelet.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

// The finest step, far below what is ever worth its bits: 2^-22 of the diagonal.
double finest_step(const ElevationMaps& maps) {
  return std::ldexp(maps.diagonal, -22);
}

CoefficientPlanes empty_planes(const ElevationPatch& patch) {
  const std::uint32_t levels = wavelet_levels(patch.columns, patch.rows);
  return {patch.columns, patch.rows, wavelet_bands(patch.columns, patch.rows, levels),
          shape_adaptive_support(patch.columns, patch.rows, levels, patch.mask)};
}

// How many passes of a map are in the stream, and from which plane they start.
struct Truncation {
  std::uint32_t planes = 0;  // 1 + the highest plane in which a coefficient is significant; 0: all are 0
  std::uint32_t passes = 0;
};

// Truncations are alike from map to map: bit by bit, each bit with the bits before it as context.
class TruncationCoding {
 public:
  template <class Coder>
  void code(Coder& coder, Truncation& truncation) {
    truncation.planes = number(coder, planes_, truncation.planes, 5);
    if (truncation.planes > 0) truncation.passes = number(coder, passes_, truncation.passes, 6);
  }

 private:
  template <class Coder>
  static std::uint32_t number(Coder& coder, SimpleBits& bits, std::uint32_t value, std::uint32_t length) {
    std::uint32_t prefix = 1;
    for (std::uint32_t bit = length; bit-- > 0;) prefix = prefix << 1 | bits.code(coder, value >> bit & 1, prefix);
    return prefix - (1U << length);
  }

  SimpleBits planes_{1U << 5}, passes_{1U << 6};
};

// What the passes of one map cost, and the error that is left behind each.
struct PassCurve {
  std::vector<double> bits = {0};
  std::vector<double> squared_error;

  std::uint32_t best(double lambda) const {
    std::uint32_t best = 0;
    for (std::uint32_t pass = 1; pass < bits.size(); ++pass)
      if (squared_error[pass] + lambda * bits[pass] < squared_error[best] + lambda * bits[best]) best = pass;
    return best;
  }
};

struct MapToWrite {
  CoefficientPlanes planes;
  std::vector<double> coefficients;
  std::uint32_t plane_count = 0;
  double weight = 1;  // of a squared error in elevation, for the surface
  double samples = 0;
};

class BaselineWriter : public ElevationWriter {
 public:
  BaselineWriter(const ElevationMaps& maps, BitDistribution distribution)
      : finest_step_(finest_step(maps)), distribution_(distribution) {
    for (const ElevationPatch& patch : maps.patches) maps_.push_back({empty_planes(patch), patch.elevation});
    thin::parallel_ranges(maps_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) prepare(maps_[i], maps.patches[i], maps.spacing);
    });
  }

  void write(double step, RangeEncoder& encoder) override {
    const std::vector<Truncation> truncations = choose(step);
    SetSplittingCoding coding;
    TruncationCoding truncation_coding;
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      Truncation truncation = truncations[i];
      truncation_coding.code(encoder, truncation);
      if (truncation.passes == 0) continue;
      std::fill(maps_[i].planes.halves.begin(), maps_[i].planes.halves.end(), 0);
      coding.code(encoder, maps_[i].planes, truncation.planes - 1, truncation.passes);
    }
  }

 private:
  void prepare(MapToWrite& map, const ElevationPatch& patch, double spacing) const {
    shape_adaptive_analysis(patch.columns, patch.rows, wavelet_levels(patch.columns, patch.rows), patch.mask,
                            map.coefficients);
    std::uint32_t all_bits = 0;
    map.planes.magnitudes.resize(map.coefficients.size());
    map.planes.negative.resize(map.coefficients.size());
    for (std::size_t i = 0; i < map.coefficients.size(); ++i) {
      const double steps = std::min(std::abs(map.coefficients[i]) / finest_step_, std::ldexp(1.0, kBitPlanes) - 1);
      map.planes.magnitudes[i] = static_cast<std::uint32_t>(steps);
      map.planes.negative[i] = map.coefficients[i] < 0;
      all_bits |= map.planes.magnitudes[i];
    }
    map.plane_count = static_cast<std::uint32_t>(std::bit_width(all_bits));
    if (distribution_ != BitDistribution::image) map.weight = mean_surface_weight(patch, spacing);
    for (const std::uint8_t supported : patch.mask) map.samples += supported;
  }

  // Costs are counted down to the plane below the step; a deeper count serves shallower steps too.
  std::vector<Truncation> choose(double step) {
    const int lowest = std::max(0, static_cast<int>(std::floor(std::log2(step / finest_step_))) - 1);
    if (curves_.empty() || lowest < lowest_counted_) count_passes(lowest);
    // At this slope a uniform quantiser of this step stands: error step² / 12, falling by 6 dB for a bit.
    const double lambda = 2 * std::log(2.0) * step * step / 12;
    std::vector<Truncation> truncations(maps_.size());
    for (std::size_t i = 0; i < maps_.size(); ++i) truncations[i] = {maps_[i].plane_count, curves_[i].best(lambda)};
    if (distribution_ == BitDistribution::even) share_evenly(truncations);
    for (std::size_t i = 0; i < maps_.size(); ++i)
      if (truncations[i].passes == 0) truncations[i].planes = 0;
    return truncations;
  }

  // The same bits in all, but as many for each sample; a map ends behind the pass nearest to its share.
  void share_evenly(std::vector<Truncation>& truncations) const {
    double bits = 0, samples = 0;
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      bits += curves_[i].bits[truncations[i].passes];
      samples += maps_[i].samples;
    }
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      const double share = samples > 0 ? bits * maps_[i].samples / samples : 0;
      const std::vector<double>& ends = curves_[i].bits;
      const auto nearest = std::min_element(
          ends.begin(), ends.end(), [share](double a, double b) { return std::abs(a - share) < std::abs(b - share); });
      truncations[i].passes = static_cast<std::uint32_t>(nearest - ends.begin());
    }
  }

  void count_passes(int lowest) {
    lowest_counted_ = lowest;
    curves_.assign(maps_.size(), {});
    SetSplittingCoding coding;
    for (std::size_t i = 0; i < maps_.size(); ++i) count_passes(coding, maps_[i], lowest, curves_[i]);
  }

  void count_passes(SetSplittingCoding& coding, MapToWrite& map, int lowest, PassCurve& curve) const {
    double error = 0;
    for (const double c : map.coefficients) error += c * c;
    curve.squared_error = {map.weight * error};
    if (static_cast<int>(map.plane_count) <= lowest) return;

    BitCounter counter;
    const double half_step = finest_step_ / 2;
    const auto squared = [&](std::uint32_t index, std::int32_t halves) {
      const double difference = map.coefficients[index] - halves * half_step;
      return difference * difference;
    };
    const SetSplittingCoding::Observer observer{[&](std::uint32_t index, std::int32_t before, std::int32_t after) {
                                                  error += squared(index, after) - squared(index, before);
                                                },
                                                [&] {
                                                  curve.bits.push_back(counter.bits());
                                                  curve.squared_error.push_back(map.weight * error);
                                                }};
    std::fill(map.planes.halves.begin(), map.planes.halves.end(), 0);
    const std::uint32_t passes = std::min(2 * (map.plane_count - static_cast<std::uint32_t>(lowest)), 63U);
    coding.code(counter, map.planes, map.plane_count - 1, passes, &observer);
  }

  double finest_step_;
  BitDistribution distribution_;
  std::vector<MapToWrite> maps_;
  std::vector<PassCurve> curves_;
  int lowest_counted_ = 0;
};

void fill_in(ElevationPatch& patch, const CoefficientPlanes& planes, double finest) {
  patch.elevation.resize(patch.mask.size());
  for (std::size_t i = 0; i < planes.halves.size(); ++i) patch.elevation[i] = planes.halves[i] * (finest / 2);
  shape_adaptive_synthesis(patch.columns, patch.rows, wavelet_levels(patch.columns, patch.rows), patch.mask,
                           patch.elevation);
}

thin::Result<void> read(RangeDecoder& decoder, double, ElevationMaps& maps) {
  SetSplittingCoding coding;
  TruncationCoding truncation_coding;
  std::vector<CoefficientPlanes> planes;
  for (const ElevationPatch& patch : maps.patches) {
    Truncation truncation;
    truncation_coding.code(decoder, truncation);
    if (truncation.planes > kBitPlanes || truncation.passes > 2 * truncation.planes)
      return thin::Error{thin::ErrorKind::input, "a map has more bit planes than there are: the stream is damaged"};
    planes.push_back(empty_planes(patch));
    if (truncation.passes > 0) coding.code(decoder, planes.back(), truncation.planes - 1, truncation.passes);
    if (decoder.exhausted())
      return thin::Error{thin::ErrorKind::incomplete,
                         "the stream ends within the elevations: it was cut or is damaged"};
  }
  thin::parallel_ranges(planes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) fill_in(maps.patches[i], planes[i], finest_step(maps));
  });
  return {};
}

}  // namespace

ElevationCoder baseline_coder() {
  return {1,
          "baseline",
          "shape-adaptive 9/7 wavelet, embedded bit planes by set splitting, truncation of each map",
          false,
          [](const ElevationMaps& maps, BitDistribution distribution) -> std::unique_ptr<ElevationWriter> {
            return std::make_unique<BaselineWriter>(maps, distribution);
          },
          &read};
}

}  // namespace emap
