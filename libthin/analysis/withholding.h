#pragma once

// Cross-validation: a part of the observations is withheld, the rest is thinned, and the withheld are predicted by
// optimal interpolation from what was retained. What a thinned set predicts of observations that no method has seen is
// what it knows about the atmosphere; no truth is needed, and the noise of the withheld is the same for all.
//
// - The withheld are every draw's share of one random order: with a share of 1/4, four draws withhold each observation
//   once; then another order is drawn. They depend on the seed and the canonical order alone.
// - From each channel the mean of the rest is taken off before: thinning and interpolation fall back to 0.
// - Length and error ratio are each method's best, found on one half of the withheld and used on the other, and the
// other
//   way round: no observation is predicted with numbers that were chosen on it.
// - Each channel is thinned and predicted alone; then all channels are thinned jointly, in units of their standard
//   deviations, and each is predicted from the joint set.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libthin/analysis/evaluation.h"

namespace thin {

struct WithholdingOptions {
  double share = 0;  // 0: no cross-validation
  int draws = 4;
  int seed = 1;
  std::vector<double> lengths_km = {125, 200, 300, 450, 650, 900};
  std::vector<double> error_ratios = {0.5, 0.7, 1, 1.4, 2, 2.8, 4};
  enum class Channels { each, joint, both };
  Channels channels = Channels::both;

  void declare(OptionTable& table);
};

// How well the withheld are predicted. One number for each draw.
struct WithheldScore {
  std::size_t set = 0;               // place in Withholding::sets
  std::optional<int> thinned_by;     // place of the channel; nothing: by all jointly
  std::optional<int> predicted;      // place of the channel; nothing: the mean over all
  std::vector<double> relative_rms;  // root mean square of what remains, over that of the withheld
  std::vector<double> explained;     // 1 - relative_rms²
  std::vector<double> share_of_all;  // explained, over what all that were not withheld explain
  std::vector<double> retained_rms;  // of the retained values, over that of all: 1 where the choice ignores them
  std::vector<double> length_km, error_ratio;  // chosen; geometric mean of the halves'
};

// What was thinned by: a variant, or a set to compare with.
struct WithheldSet {
  std::string label;  // "all", "farthest_point", "random", or the variant's
  std::optional<std::size_t> variant;
  std::optional<std::int64_t> asked;  // nothing: all, or the method stops by itself
  std::vector<double> retained;       // mean over draws, for each of `channels`' thinnings: each channel, then jointly
};

struct ChannelFacts {
  double mean_k = 0, standard_deviation_k = 0;
  double excess_kurtosis = 0;  // 0 for normal; far above it, outliers are left in
};

struct Withholding {
  std::vector<WithheldSet> sets;
  std::vector<WithheldScore> scores;
  std::vector<ChannelFacts> channels;
  std::size_t withheld_count = 0, rest_count = 0;
  std::vector<Evaluation::Failure> failures;
  std::vector<std::string> notes;  // what a reader must know
};

// Observations are in canonical order, prepared; of one instrument. Variants that can't be told a number are fitted to
// it. A method's errors make a Failure. Errors: input, where there are too few observations, or values are missing.
Result<Withholding> withhold(const ObservationSet& observations, const std::vector<Variant>& variants,
                             const std::vector<int>& counts, const WithholdingOptions& options,
                             const std::function<void(const std::string&)>& progress);

// Of draw `draw`, ascending: which of n are withheld.
std::vector<std::uint32_t> withheld_in_draw(std::size_t n, double share, int draw, int seed);

}  // namespace thin
