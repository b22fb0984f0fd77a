#include "libemap/coding/encoding_trial.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "libemap/coding/stream.h"
#include "libemap/elevation/map_grid.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using thin::Result;

constexpr std::uint32_t kManySamples = 600;  // to the diagonal, of a model of many points
constexpr std::int32_t kRoom = 6;            // samples in front of a patch, into which its seams may move
constexpr std::uint32_t kMargin = 1;  // samples around each map; decides which of them interpolation leaves as they are
constexpr double kClose = 0.985;      // of a wanted size or error: near enough
constexpr double kFlattest = 0.2;     // of the error against the step, in logarithms: below, the grid is too coarse
constexpr double kLogBytesPer_dB = 0.112;  // of usual models and rates

// Patches between whose samples everything falls.
void drop_empty(std::vector<CodedPlane>& planes, ElevationMaps& maps) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::vector<std::uint8_t>& mask = maps.patches[i].mask;
    if (std::find(mask.begin(), mask.end(), 1) == mask.end()) continue;
    if (kept != i) {
      planes[kept] = planes[i];
      maps.patches[kept] = std::move(maps.patches[i]);
    }
    ++kept;
  }
  planes.resize(kept);
  maps.patches.resize(kept);
}

StreamWriter writer_of(const EncodingTarget& target, const SurfaceToEncode& surface,
                       std::uint32_t samples_per_diagonal) {
  const StreamFrame frame = stream_frame(surface.box(), samples_per_diagonal);
  std::vector<CodedPlane> coded(surface.planes().size());
  std::vector<BasePlane> planes(coded.size());
  thin::parallel_ranges(coded.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      coded[i] = quantise_plane(surface.planes()[i], surface.positions_of(i), frame);
      coded[i].origin_u -= kRoom;
      coded[i].origin_v -= kRoom;
      planes[i] = base_plane_of(coded[i], frame);
    }
  });
  ElevationMaps maps = surface.resample(planes, frame.spacing(), mask_effort(target, surface, samples_per_diagonal));
  maps.diagonal = frame.box.diagonal();
  drop_empty(coded, maps);
  for (std::size_t i = 0; i < coded.size(); ++i) {
    const ShiftedOrigin shifted = set_margin(kMargin, maps.patches[i]);
    coded[i].origin_u += shifted.columns;
    coded[i].origin_v += shifted.rows;
    maps.patches[i].plane = base_plane_of(coded[i], frame);
  }
  return StreamWriter(*target.coder, frame, std::move(coded), std::move(maps), surface.is_points(),
                      target.distribution);
}

double error_of(const SurfaceToEncode& surface, const std::vector<std::uint8_t>& stream, bool quick = false) {
  const Result<DecodedStream> decoded = read_stream(stream);
  return decoded ? surface.error_of(decoded->maps, quick) : std::numeric_limits<double>::infinity();
}

void write(const EncodingTarget& target, StreamWriter& writer, double step, bool quick, EncodingTrial& trial) {
  trial.stream = writer.write(step);
  trial.step = step;
  trial.error = error_of(*trial.surface, trial.stream, quick);
  trial.meets_target = target.is_quality() ? trial.error <= target.largest_error
                                           : static_cast<double>(trial.stream.size()) <= target.most_bytes;
}

// The largest stream that fits, or nearly: false position between the logarithms of steps and sizes.
EncodingTrial to_rate(const EncodingTarget& target, StreamWriter& writer, EncodingTrial best, double first_step) {
  struct Side {
    double log_step, log_ratio;
  };
  std::optional<Side> fits, exceeds;
  double log_step = std::log(first_step);
  for (int round = 0; round < 9; ++round) {
    std::vector<std::uint8_t> stream = writer.write(std::exp(log_step));
    const double ratio = static_cast<double>(stream.size()) / target.most_bytes;
    (ratio <= 1 ? fits : exceeds) = Side{log_step, std::log(ratio)};
    if (ratio <= 1 && stream.size() > best.stream.size()) {
      best.stream = std::move(stream);
      best.step = std::exp(log_step);
      best.meets_target = true;
    }
    if ((ratio <= 1 && ratio >= kClose) || (round >= 5 && best.meets_target)) break;
    const double wanted = std::log(kClose) / 2;
    if (fits && exceeds)
      log_step = fits->log_step + (exceeds->log_step - fits->log_step) * (wanted - fits->log_ratio) /
                                      (exceeds->log_ratio - fits->log_ratio);
    else
      log_step += std::clamp(1.3 * (std::log(ratio) - wanted), -1.6, 2.0);
  }
  if (best.meets_target) best.error = error_of(*best.surface, best.stream);
  best.meets_target = std::isfinite(best.error);
  return best;
}

// The smallest stream that is good enough, or nearly.
EncodingTrial to_quality(const EncodingTarget& target, StreamWriter& writer, EncodingTrial best, double first_step) {
  const EncodingTrial empty = best;
  double step = first_step;
  double exponent = 1;
  double last_ratio = 0, last_step = 0;
  for (int round = 0; round < 6; ++round) {
    EncodingTrial trial = empty;
    write(target, writer, step, false, trial);
    const double ratio = trial.error / target.largest_error;
    if (best.stream.empty() || is_better(target, trial, best)) best = std::move(trial);
    if ((ratio <= 1 && ratio >= kClose) || (round >= 3 && best.meets_target)) break;
    // How the error goes with the step was seen in the last two rounds; where it hardly does, the grid is too coarse.
    if (last_step > 0) {
      exponent = std::log(ratio / last_ratio) / std::log(step / last_step);
      if (exponent < kFlattest && ratio > 1) break;
      exponent = std::clamp(exponent, 0.25, 1.2);
    }
    last_ratio = ratio;
    last_step = step;
    step *= std::clamp(std::pow(0.993 / ratio, 1 / exponent), 0.1, 8.0);
  }
  return best;
}

}  // namespace

MaskEffort mask_effort(const EncodingTarget& target, const SurfaceToEncode& surface,
                       std::uint32_t samples_per_diagonal) {
  if (surface.point_count() > kManyPoints && samples_per_diagonal > kManySamples) return MaskEffort::none;
  return target.may_smooth_seams ? MaskEffort::seams : MaskEffort::boundaries;
}

double EncodingTarget::psnr_db(double error) const {
  return 20 * std::log10(diagonal / error);
}

EncodingTrial try_to_meet(const EncodingTarget& target, const SharedSurface& surface,
                          std::uint32_t samples_per_diagonal, double first_step) {
  StreamWriter writer = writer_of(target, *surface, samples_per_diagonal);
  EncodingTrial empty;
  empty.surface = surface;
  empty.samples_per_diagonal = samples_per_diagonal;
  if (!(first_step > 0)) first_step = target.is_quality() ? 6 * target.largest_error : 7e-4 * target.diagonal;
  return target.is_quality() ? to_quality(target, writer, std::move(empty), first_step)
                             : to_rate(target, writer, std::move(empty), first_step);
}

EncodingTrial try_step(const EncodingTarget& target, const SharedSurface& surface, std::uint32_t samples_per_diagonal,
                       double step) {
  StreamWriter writer = writer_of(target, *surface, samples_per_diagonal);
  EncodingTrial trial;
  trial.surface = surface;
  trial.samples_per_diagonal = samples_per_diagonal;
  write(target, writer, step, true, trial);
  return trial;
}

bool is_better(const EncodingTarget& target, const EncodingTrial& a, const EncodingTrial& b) {
  if (a.meets_target != b.meets_target) return a.meets_target;
  if (target.is_quality() && a.meets_target) return a.stream.size() < b.stream.size();
  return a.error < b.error;
}

double cost_at_equal_quality(const EncodingTarget& target, const EncodingTrial& trial) {
  if (!std::isfinite(trial.error)) return std::numeric_limits<double>::infinity();
  return std::log(static_cast<double>(trial.stream.size())) - kLogBytesPer_dB * target.psnr_db(trial.error);
}

}  // namespace emap
