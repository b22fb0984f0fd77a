#include "libemap/coding/encoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "libemap/coding/stream.h"
#include "libemap/elevation/map_grid.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

constexpr std::uint32_t kFewestSamples = 16;
constexpr std::uint32_t kMostSamples = 6000;
constexpr std::int32_t kRoom = 6;     // samples in front of a patch, into which its seams may move
constexpr std::uint32_t kMargin = 1;  // samples around each map; decides which of them interpolation leaves as they are
constexpr double kClose = 0.985;      // of a wanted size or error: near enough
constexpr double kResolutionRatio = 1.2599;  // between resolutions that are tried: the cube root of two

constexpr double kCoarsestError = 1e-3;  // in diagonals, that partitions are made for
// Beyond which other partitions, which take seconds each, are tried only where the first does not lead to the target.
constexpr std::size_t kManyPoints = 200000;
constexpr std::uint32_t kManySamples = 600;  // to the diagonal

// A surface sampled at one resolution, ready to be written.
struct Resolution {
  std::uint32_t samples_per_diagonal;
  StreamWriter writer;
};

struct Trial {
  std::vector<std::uint8_t> stream;
  double step = 0;
  double error = std::numeric_limits<double>::infinity();
  std::uint32_t samples_per_diagonal = 0;
  bool meets_target = false;
};

class Search {
 public:
  Search(const SurfaceToEncode& surface, const EncoderOptions& options)
      : surface_(&surface), options_(options), diagonal_(stream_frame(surface.box(), 1).box.diagonal()) {
    if (options.bits_per_point) most_bytes_ = *options.bits_per_point * static_cast<double>(surface.point_count()) / 8;
    if (options.psnr_db) largest_error_ = diagonal_ * std::pow(10.0, -*options.psnr_db / 20);
  }

  Result<Encoded> run() {
    Trial best = at(options_.samples_per_diagonal.value_or(first_guess()));
    if (options_.may_repartition) best = with_best_partition(std::move(best));
    best = with_best_seams(std::move(best));
    if (options_.samples_per_diagonal) return finished(std::move(best));
    // Work is bounded by the size of the model, not by the clock: the same model gives the same bytes everywhere.
    const auto resolutions =
        static_cast<int>(std::clamp(3e6 / static_cast<double>(surface_->point_count()), 3.0, 10.0));
    for (int climb = 0, tried = 1; tried < resolutions && !best.meets_target && climb < 6; ++climb, ++tried)
      best = better(std::move(best), at(scaled(best.samples_per_diagonal, options_.psnr_db ? 1.6 : 1 / 1.6)));
    if (!best.meets_target) return finished(std::move(best));
    for (const double ratio : {1 / kResolutionRatio, kResolutionRatio})
      for (int tried = 0; tried < resolutions / 2; ++tried) {
        const std::uint32_t next = scaled(best.samples_per_diagonal, ratio);
        if (seen_.contains(next)) break;
        Trial trial = at(next);
        const bool improved = is_better(trial, best);
        best = better(std::move(best), std::move(trial));
        if (!improved) break;
      }
    return finished(std::move(best));
  }

 private:
  static std::uint32_t scaled(std::uint32_t samples, double ratio) {
    return std::clamp(static_cast<std::uint32_t>(std::lround(samples * ratio)), kFewestSamples, kMostSamples);
  }

  // Of the partitions that suit such errors, the one that does best at this resolution stays.
  Trial with_best_partition(Trial best) {
    if (best.meets_target && surface_->point_count() > kManyPoints) return best;
    const double error = std::clamp(options_.psnr_db    ? largest_error_
                                    : best.meets_target ? best.error
                                                        : kCoarsestError * diagonal_,
                                    0.0, kCoarsestError * diagonal_);
    const std::uint32_t samples = best.samples_per_diagonal;
    for (const PartitionOptions& partition : partitions_for(error / diagonal_)) {
      Result<std::unique_ptr<SurfaceToEncode>> other = surface_->repartitioned(partition);
      if (!other) continue;
      const SurfaceToEncode* last = std::exchange(surface_, other->get());
      if (options_.progress) options_.progress(fmt::format("{} patches", surface_->planes().size()));
      Trial trial = at(samples);
      if (is_better(trial, best)) {
        best = std::move(trial);
        repartitioned_ = std::move(*other);
      } else {
        surface_ = last;
      }
    }
    return best;
  }

  // Smooth seams or those of the partition, whichever do better at this resolution.
  Trial with_best_seams(Trial best) {
    if (mask_effort(best.samples_per_diagonal) == MaskEffort::none) return best;
    smooth_seams_ = false;
    Trial trial = at(best.samples_per_diagonal);
    smooth_seams_ = !is_better(trial, best);
    return better(std::move(best), std::move(trial));
  }

  // On large models with fine maps, looking for what gap filling misses takes longer than all the rest, and masks are a
  // small share of the bits.
  MaskEffort mask_effort(std::uint32_t samples_per_diagonal) const {
    if (surface_->point_count() > kManyPoints && samples_per_diagonal > kManySamples) return MaskEffort::none;
    return smooth_seams_ ? MaskEffort::seams : MaskEffort::boundaries;
  }

  // error: in diagonals. Normals are smoothed more, and what lies nearer than the error counts as one sheet.
  std::vector<PartitionOptions> partitions_for(double error) const {
    std::vector<PartitionOptions> partitions;
    for (const int smoothing_rounds : {8, 20, 60}) {
      PartitionOptions partition;
      partition.smoothing_rounds = smoothing_rounds;
      partition.fold_tolerance = std::max(partition.fold_tolerance, error);
      partition.scrap_error = std::max(partition.scrap_error, 0.4 * error);
      partitions.push_back(partition);
    }
    return partitions;
  }

  // A bit or two for each sample of the maps are about right for a rate; for a quality, interpolation errs by a power
  // of the spacing.
  std::uint32_t first_guess() const {
    constexpr double kAreaOfDiagonalSquared = 0.8;  // of usual models
    const double finer = (options_.coder->leaves_finest_band_out ? 1 : 0.8) * (surface_->is_points() ? 1.3 : 1);
    if (options_.psnr_db) return scaled(1, finer * 520 * std::pow(10.0, (*options_.psnr_db - 80) / 45));
    return scaled(1, finer * 1.25 * std::sqrt(8 * most_bytes_ / kAreaOfDiagonalSquared));
  }

  bool is_better(const Trial& a, const Trial& b) const {
    if (a.meets_target != b.meets_target) return a.meets_target;
    if (options_.psnr_db && a.meets_target) return a.stream.size() < b.stream.size();
    return a.error < b.error;
  }
  Trial better(Trial a, Trial b) const { return is_better(b, a) ? std::move(b) : std::move(a); }

  Trial at(std::uint32_t samples_per_diagonal) {
    seen_[samples_per_diagonal] = true;
    Resolution resolution = sampled(samples_per_diagonal);
    Trial trial = options_.psnr_db ? to_quality(resolution) : to_rate(resolution);
    trial.samples_per_diagonal = samples_per_diagonal;
    if (trial.meets_target) last_step_ = trial.step;
    if (options_.progress)
      options_.progress(fmt::format("{} samples to the diagonal: {} bytes, {:.2f} dB{}", samples_per_diagonal,
                                    trial.stream.size(), psnr_db(trial.error),
                                    trial.meets_target ? "" : " (not what is wanted)"));
    return trial;
  }

  Resolution sampled(std::uint32_t samples_per_diagonal) const {
    const StreamFrame frame = stream_frame(surface_->box(), samples_per_diagonal);
    std::vector<CodedPlane> coded(surface_->planes().size());
    std::vector<BasePlane> planes(coded.size());
    thin::parallel_ranges(coded.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        coded[i] = quantise_plane(surface_->planes()[i], surface_->positions_of(i), frame);
        coded[i].origin_u -= kRoom;
        coded[i].origin_v -= kRoom;
        planes[i] = base_plane_of(coded[i], frame);
      }
    });
    ElevationMaps maps = surface_->resample(planes, frame.spacing(), mask_effort(samples_per_diagonal));
    maps.diagonal = frame.box.diagonal();
    drop_empty(coded, maps);
    for (std::size_t i = 0; i < coded.size(); ++i) {
      const ShiftedOrigin shifted = set_margin(kMargin, maps.patches[i]);
      coded[i].origin_u += shifted.columns;
      coded[i].origin_v += shifted.rows;
      maps.patches[i].plane = base_plane_of(coded[i], frame);
    }
    return {samples_per_diagonal, StreamWriter(*options_.coder, frame, std::move(coded), std::move(maps),
                                               surface_->is_points(), options_.distribution)};
  }

  // Patches between whose samples everything falls.
  static void drop_empty(std::vector<CodedPlane>& planes, ElevationMaps& maps) {
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

  double first_step() const {
    if (last_step_ > 0) return last_step_;
    return options_.psnr_db ? 6 * largest_error_ : 7e-4 * diagonal_;
  }

  // The largest stream that fits, or nearly: false position between the logarithms of steps and sizes.
  Trial to_rate(Resolution& resolution) {
    struct Side {
      double log_step, log_ratio;
    };
    std::optional<Side> fits, exceeds;
    Trial best;
    double log_step = std::log(first_step());
    for (int round = 0; round < 9; ++round) {
      std::vector<std::uint8_t> stream = resolution.writer.write(std::exp(log_step));
      const double ratio = static_cast<double>(stream.size()) / most_bytes_;
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
    if (best.meets_target) best.error = error_of(best.stream);
    best.meets_target = std::isfinite(best.error);
    return best;
  }

  // The smallest stream that is good enough, or nearly.
  Trial to_quality(Resolution& resolution) {
    Trial best;
    double step = first_step();
    double exponent = 1;
    double last_ratio = 0, last_step = 0;
    for (int round = 0; round < 6; ++round) {
      Trial trial;
      trial.stream = resolution.writer.write(step);
      trial.step = step;
      trial.error = error_of(trial.stream);
      const double ratio = trial.error / largest_error_;
      trial.meets_target = ratio <= 1;
      if (best.stream.empty() || is_better(trial, best)) best = std::move(trial);
      if ((ratio <= 1 && ratio >= kClose) || (round >= 3 && best.meets_target)) break;
      // How the error goes with the step was seen in the last two rounds; where it hardly does, the grid is too coarse.
      if (last_step > 0) {
        exponent = std::log(ratio / last_ratio) / std::log(step / last_step);
        if (exponent < 0.08 && ratio > 1) break;
        exponent = std::clamp(exponent, 0.25, 1.2);
      }
      last_ratio = ratio;
      last_step = step;
      step *= std::clamp(std::pow(0.993 / ratio, 1 / exponent), 0.1, 8.0);
    }
    return best;
  }

  double error_of(const std::vector<std::uint8_t>& stream) const {
    const Result<DecodedStream> decoded = read_stream(stream);
    return decoded ? surface_->error_of(decoded->maps) : std::numeric_limits<double>::infinity();
  }

  double psnr_db(double error) const { return 20 * std::log10(diagonal_ / error); }

  Result<Encoded> finished(Trial trial) const {
    if (!trial.stream.empty() && !std::isfinite(trial.error))
      return Error{ErrorKind::input,
                   fmt::format("nothing of the surface lies at the samples of {} to the diagonal; set "
                               "a finer --resolution",
                               trial.samples_per_diagonal)};
    if (!trial.meets_target && options_.bits_per_point)
      return Error{ErrorKind::configuration,
                   fmt::format("{} bits per point, {:.0f} bytes, are fewer than planes and masks of {} patches take; "
                               "allow more or a wider aperture",
                               *options_.bits_per_point, most_bytes_, surface_->planes().size())};
    if (!trial.meets_target)
      return Error{ErrorKind::configuration,
                   fmt::format("{} dB were not reached; the best was {:.2f} dB at {} samples to the diagonal; ask for "
                               "less, or set a finer --resolution",
                               *options_.psnr_db, psnr_db(trial.error), trial.samples_per_diagonal)};
    const std::size_t patches = read_stream_header(trial.stream)->patch_count;
    return Encoded{std::move(trial.stream), psnr_db(trial.error), trial.samples_per_diagonal, patches};
  }

  const SurfaceToEncode* surface_;
  std::unique_ptr<SurfaceToEncode> repartitioned_;  // what surface_ points to, where it is not the one given
  const EncoderOptions& options_;
  double diagonal_;
  double most_bytes_ = 0;
  double largest_error_ = 0;
  bool smooth_seams_ = true;
  double last_step_ = 0;  // of the last trial that met the target
  std::map<std::uint32_t, bool> seen_;
};

}  // namespace

Result<Encoded> encode_surface(const SurfaceToEncode& surface, const EncoderOptions& options) {
  if (options.bits_per_point.has_value() == options.psnr_db.has_value())
    return Error{ErrorKind::configuration, "state either bits per point or a PSNR"};
  if (!(surface.box().diagonal() > 0))
    return Error{ErrorKind::input, "the surface has no extent: all its points are in one place"};
  return Search(surface, options).run();
}

}  // namespace emap
