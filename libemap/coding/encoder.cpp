#include "libemap/coding/encoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "libemap/coding/encoding_trial.h"
#include "libemap/coding/stream.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

constexpr std::uint32_t kFewestSamples = 16;
constexpr std::uint32_t kMostSamples = 6000;
constexpr double kResolutionRatio = 1.2599;  // between resolutions that are tried: the cube root of two

constexpr double kLeastGain = 0.01;  // of bytes, by a look at another resolution that is worth going there
constexpr double kLeastHelp = 0.95;  // of the error, that is left by a finer resolution that is worth going on

constexpr double kCoarsestError = 1e-3;  // in diagonals, that partitions are made for
constexpr double kFineError = 1.5e-4;    // below, other cuts gain little where there are many patches
// Share of the error that scraps may make up, which saves patches of their own. Where it is much, rare large errors are
// what is left of the surface's folds.
constexpr double kScrapShare = 0.15;
constexpr std::size_t kMostPointsAtOnce = 2000000;  // of all tries that run at the same time
constexpr std::size_t kMostAtOnce = 8;

// How a surface may be cut: the aperture, and rounds of smoothing of the normals that it is for.
struct Cut {
  int aperture_degrees, smoothing_rounds;
  bool operator==(const Cut&) const = default;
};

// Steep slopes cost more than fewer patches save, down to about 65 degrees; what does best differs between models by
// more than can be told beforehand.
constexpr std::array kCuts = {Cut{70, 60}, Cut{70, 20}, Cut{65, 60}, Cut{60, 99}, Cut{70, 2}, Cut{80, 2}};
constexpr std::array kCutsOfManyPoints = {Cut{70, 60}, Cut{80, 2}};
// Where the target is not met: of meshes of a few triangles, smoothing leaves nothing.
constexpr Cut kUnsmoothedCut = {80, 0};

class Search {
 public:
  Search(const SurfaceToEncode& surface, const EncoderOptions& options)
      : surface_(&surface, [](const SurfaceToEncode*) {}), options_(options) {
    target_.diagonal = stream_frame(surface.box(), 1).box.diagonal();
    if (options.bits_per_point)
      target_.most_bytes = *options.bits_per_point * static_cast<double>(surface.point_count()) / 8;
    if (options.psnr_db) target_.largest_error = target_.diagonal * std::pow(10.0, -*options.psnr_db / 20);
    target_.coder = options.coder;
    target_.distribution = options.distribution;
  }

  Result<Encoded> run() {
    EncodingTrial best = at(surface_, options_.samples_per_diagonal.value_or(first_guess()), 0);
    // A rate that is not met wants fewer patches, a quality that is not met finer maps.
    if (target_.is_quality() && !options_.samples_per_diagonal) best = climbed(std::move(best));
    if (options_.may_repartition) best = with_best_partition(std::move(best));
    best = with_best_seams(std::move(best));
    if (options_.samples_per_diagonal) return finished(best);
    best = climbed(std::move(best));
    if (!best.meets_target) return finished(best);
    return finished(at_best_resolution(std::move(best)));
  }

 private:
  static std::uint32_t scaled(std::uint32_t samples, double ratio) {
    return std::clamp(static_cast<std::uint32_t>(std::lround(samples * ratio)), kFewestSamples, kMostSamples);
  }

  // A bit or two for each sample of the maps are about right for a rate; for a quality, interpolation errs by a power
  // of the spacing.
  std::uint32_t first_guess() const {
    constexpr double kAreaOfDiagonalSquared = 0.8;  // of usual models
    const double finer = (options_.coder->leaves_finest_band_out ? 1 : 0.8) * (surface_->is_points() ? 1.3 : 1);
    if (options_.psnr_db) return scaled(1, finer * 520 * std::pow(10.0, (*options_.psnr_db - 80) / 45));
    return scaled(1, finer * 1.5 * std::sqrt(8 * target_.most_bytes / kAreaOfDiagonalSquared));
  }

  EncodingTrial at(const SharedSurface& surface, std::uint32_t samples_per_diagonal, double first_step) const {
    EncodingTrial trial = try_to_meet(target_, surface, samples_per_diagonal, first_step);
    tell(trial);
    return trial;
  }

  void tell(const EncodingTrial& trial) const {
    if (options_.progress)
      options_.progress(fmt::format("{} patches, {} samples to the diagonal: {} bytes, {:.2f} dB{}",
                                    trial.surface->planes().size(), trial.samples_per_diagonal, trial.stream.size(),
                                    target_.psnr_db(trial.error), trial.meets_target ? "" : " (not what is wanted)"));
  }

  EncodingTrial better(EncodingTrial a, EncodingTrial b) const {
    return is_better(target_, b, a) ? std::move(b) : std::move(a);
  }

  // Work is bounded by the size of the model, not by the clock: the same model gives the same bytes everywhere.
  int most_resolutions() const {
    return static_cast<int>(std::clamp(3e6 / static_cast<double>(surface_->point_count()), 3.0, 10.0));
  }

  // Finer maps until the quality is reached, or coarser ones until the rate is; a quality only as long as that helps.
  EncodingTrial climbed(EncodingTrial best) const {
    for (int tried = 1; tried < std::min(most_resolutions(), 6) && !best.meets_target; ++tried) {
      const std::uint32_t next = scaled(best.samples_per_diagonal, target_.is_quality() ? 1.6 : 1 / 1.6);
      if (next == best.samples_per_diagonal) break;
      EncodingTrial trial = at(best.surface, next, 0);
      // Not by which is better: of two that fail, the next one goes on from the latter.
      if (trial.stream.empty() && !best.stream.empty()) break;
      const bool helps = !(trial.error > kLeastHelp * best.error) || !std::isfinite(best.error);
      best = std::move(trial);
      if (!helps) break;
    }
    return best;
  }

  // The next coarser and the next finer resolution; on in the direction that is better, as long as it is.
  EncodingTrial at_best_resolution(EncodingTrial best) const {
    constexpr std::array kRatios = {1 / kResolutionRatio, kResolutionRatio};
    const std::uint32_t middle = best.samples_per_diagonal;
    const bool looks_first = surface_->point_count() > kManyPoints;
    std::vector<EncodingTrial> sides = all_of(kRatios.size(), [&, step = best.step](std::size_t i) {
      const std::uint32_t samples = scaled(middle, kRatios[i]);
      return looks_first ? try_step(target_, best.surface, samples, step)
                         : try_to_meet(target_, best.surface, samples, step);
    });
    const double own_cost = cost_at_equal_quality(target_, best);
    for (std::size_t side = 0; side < sides.size(); ++side) {
      if (looks_first && !(cost_at_equal_quality(target_, sides[side]) < own_cost - kLeastGain)) continue;
      EncodingTrial trial =
          looks_first ? at(best.surface, scaled(middle, kRatios[side]), best.step) : std::move(sides[side]);
      if (!looks_first) tell(trial);
      for (int tried = 1; is_better(target_, trial, best); ++tried) {
        best = std::move(trial);
        if (tried >= most_resolutions() / 2) break;
        trial = at(best.surface, scaled(best.samples_per_diagonal, kRatios[side]), best.step);
      }
      if (best.samples_per_diagonal != middle) break;
    }
    return best;
  }

  // make(0) ... make(count - 1), as many at once as memory should bear; in their order.
  template <class Make>
  std::vector<EncodingTrial> all_of(std::size_t count, const Make& make) const {
    const std::size_t at_once =
        std::clamp<std::size_t>(kMostPointsAtOnce / std::max<std::size_t>(surface_->point_count(), 1), 1, kMostAtOnce);
    std::vector<EncodingTrial> trials(count);
    for (std::size_t first = 0; first < count; first += at_once)
      thin::parallel_ranges(std::min(at_once, count - first), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = first + begin; i < first + end; ++i) trials[i] = make(i);
      });
    return trials;
  }

  // Each of many ways to cut is looked at once, at the best try's resolution and step; those around the one that does
  // best likewise; then the two that did best go the whole way.
  EncodingTrial with_best_partition(EncodingTrial best) const {
    const bool has_many_points = surface_->point_count() > kManyPoints;
    const double error = error_to_cut_for(best) / target_.diagonal;
    const bool would_gain_little = error < kFineError || surface_->point_count() > 5 * kManyPoints;
    if (has_many_points && best.meets_target && would_gain_little) return best;
    if (target_.is_quality() && !best.meets_target && has_many_points) return best;
    std::vector<Cut> cuts = has_many_points ? std::vector(kCutsOfManyPoints.begin(), kCutsOfManyPoints.end())
                                            : std::vector(kCuts.begin(), kCuts.end());
    if (!best.meets_target) cuts.push_back(kUnsmoothedCut);
    std::vector<EncodingTrial> looks = looked_at(cuts, 0, error, best);
    if (!has_many_points) {
      const std::size_t known = cuts.size();
      add_cuts_around(cuts[order_of(looks).front()], cuts);
      for (EncodingTrial& look : looked_at(cuts, known, error, best)) looks.push_back(std::move(look));
    }
    const std::vector<std::size_t> order = order_of(looks);
    const double own_cost = cost_at_equal_quality(target_, best);
    const std::size_t finalists = std::min<std::size_t>(has_many_points ? 1 : 2, order.size());
    std::vector<EncodingTrial> finals = all_of(finalists, [&](std::size_t i) {
      const EncodingTrial& look = looks[order[i]];
      const bool is_hopeless = best.meets_target && cost_at_equal_quality(target_, look) > own_cost;
      return look.surface && !is_hopeless
                 ? try_to_meet(target_, look.surface, best.samples_per_diagonal, best.meets_target ? best.step : 0)
                 : EncodingTrial{};
    });
    for (EncodingTrial& trial : finals) {
      if (!trial.surface) continue;
      tell(trial);
      best = better(std::move(best), std::move(trial));
    }
    return best;
  }

  // Smooth seams or those of the partition, whichever do better at this resolution; for all tries from here on.
  EncodingTrial with_best_seams(EncodingTrial best) {
    if (!best.meets_target || mask_effort(target_, *best.surface, best.samples_per_diagonal) == MaskEffort::none)
      return best;
    target_.may_smooth_seams = false;
    EncodingTrial trial = at(best.surface, best.samples_per_diagonal, best.step);
    target_.may_smooth_seams = !is_better(target_, trial, best);
    return better(std::move(best), std::move(trial));
  }

  // Where a rate is not met, errors are as large as they may be.
  double error_to_cut_for(const EncodingTrial& best) const {
    const double coarsest = kCoarsestError * target_.diagonal;
    if (target_.is_quality()) return std::min(target_.largest_error, coarsest);
    return best.meets_target ? std::min(best.error, coarsest) : coarsest;
  }

  // Those from `first` on. A cut that fails is one without a surface.
  std::vector<EncodingTrial> looked_at(const std::vector<Cut>& cuts, std::size_t first, double error,
                                       const EncodingTrial& best) const {
    std::vector<EncodingTrial> looks = all_of(cuts.size() - first, [&](std::size_t i) {
      Result<std::unique_ptr<SurfaceToEncode>> cut = surface_->repartitioned(partition_for(cuts[first + i], error));
      if (!cut) return EncodingTrial{};
      const SharedSurface surface = std::move(*cut);
      return best.meets_target ? try_step(target_, surface, best.samples_per_diagonal, best.step)
                               : try_to_meet(target_, surface, best.samples_per_diagonal, 0);
    });
    if (options_.progress)
      for (std::size_t i = 0; i < looks.size(); ++i)
        if (looks[i].surface)
          options_.progress(fmt::format("aperture {}, smoothing {}: {} patches, {} bytes, {:.2f} dB",
                                        cuts[first + i].aperture_degrees, cuts[first + i].smoothing_rounds,
                                        looks[i].surface->planes().size(), looks[i].stream.size(),
                                        target_.psnr_db(looks[i].error)));
    return looks;
  }

  // error: in diagonals. What lies nearer than it counts as one sheet.
  static PartitionOptions partition_for(const Cut& cut, double error) {
    PartitionOptions partition;
    partition.aperture_degrees = cut.aperture_degrees;
    partition.smoothing_rounds = cut.smoothing_rounds;
    partition.fold_tolerance = std::max(partition.fold_tolerance, error);
    partition.scrap_error = std::max(partition.scrap_error, kScrapShare * error);
    return partition;
  }

  static void add_cuts_around(const Cut& middle, std::vector<Cut>& cuts) {
    for (const Cut& cut : {Cut{middle.aperture_degrees - 5, middle.smoothing_rounds},
                           Cut{middle.aperture_degrees + 5, middle.smoothing_rounds},
                           Cut{middle.aperture_degrees, middle.smoothing_rounds / 2},
                           Cut{middle.aperture_degrees, std::min(99, middle.smoothing_rounds * 3 / 2 + 1)}})
      if (cut.aperture_degrees <= 85 && std::find(cuts.begin(), cuts.end(), cut) == cuts.end()) cuts.push_back(cut);
  }

  // The cheapest at equal quality first, ties by their order.
  std::vector<std::size_t> order_of(const std::vector<EncodingTrial>& looks) const {
    std::vector<double> costs;
    for (const EncodingTrial& look : looks) costs.push_back(cost_at_equal_quality(target_, look));
    std::vector<std::size_t> order(looks.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
    return order;
  }

  Result<Encoded> finished(const EncodingTrial& trial) const {
    if (!trial.stream.empty() && !std::isfinite(trial.error))
      return Error{ErrorKind::input,
                   fmt::format("nothing of the surface lies at the samples of {} to the diagonal; set "
                               "a finer --resolution",
                               trial.samples_per_diagonal)};
    if (!trial.meets_target && options_.bits_per_point)
      return Error{ErrorKind::configuration,
                   fmt::format("{} bits per point, {:.0f} bytes, are fewer than planes and masks of {} patches take; "
                               "allow more or a wider aperture",
                               *options_.bits_per_point, target_.most_bytes, trial.surface->planes().size())};
    if (!trial.meets_target)
      return Error{ErrorKind::configuration,
                   fmt::format("{} dB were not reached; the best was {:.2f} dB at {} samples to the diagonal; ask for "
                               "less, or set a finer --resolution",
                               *options_.psnr_db, target_.psnr_db(trial.error), trial.samples_per_diagonal)};
    const std::size_t patches = read_stream_header(trial.stream)->patch_count;
    return Encoded{trial.stream, target_.psnr_db(trial.error), trial.samples_per_diagonal, patches};
  }

  SharedSurface surface_;  // as it was given
  const EncoderOptions& options_;
  EncodingTarget target_;
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
