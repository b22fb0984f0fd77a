#pragma once

// From any thinned set to a better one of the same size: the thesis stops at the greedy choice, which is far from the
// best (28 % and more of the estimation error can be had). Both refinements work on the exact sums, never raise E, and
// give the same result for the same input and seed, whatever the number of threads.

#include <cstdint>
#include <optional>
#include <span>

#include "libthin/estimation/estimation_sums.h"
#include "libthin/estimation/local_analysis.h"
#include "libthin/foundation/options.h"
#include "libthin/thinning/separation.h"

namespace thin {

enum class Refinement {
  none,
  exchange,   // the best insertion with the best removal, in both orders, until no pair lowers E
  annealing,  // random swaps of near neighbours, with ever fewer of those accepted that raise E; then exchange
};

struct RefinementOptions {
  Refinement refine = Refinement::none;
  int starts = 1;  // the greedy set, then random ones; the best result is taken
  int seed = 1;
  double effort = 1;  // annealing: 1 is about as long as the greedy choice takes

  void declare(OptionTable& table);
};

// What a swap must respect.
struct SwapRules {
  std::span<const double> priority = {};   // n, or empty: nothing is swapped for something of lower priority
  const Separation* separation = nullptr;  // nothing is retained that stands too near to another
};

// What an exchange must gain at least, as a share of the error, so that rounding alone keeps nothing going.
constexpr double kLeastGain = 1e-12;

// Swaps retained against given-up observations of `sums` (EstimationSums, LocalAnalysis) while |Q| E, or J, falls.
// Returns the number of swaps.
template <class Sums>
std::size_t exchange(Sums& sums, const SwapRules& rules, double least_gain = kLeastGain);

// `trials` random swaps.
void anneal(EstimationSums& sums, const SwapRules& rules, std::uint64_t trials, std::uint64_t seed);

// As the options say. `sums` holds the greedy set, and afterwards the best.
void refine(EstimationSums& sums, const SwapRules& rules, const RefinementOptions& options);

}  // namespace thin
