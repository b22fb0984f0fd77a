#include "libthin/thinning/refinement.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "libthin/thinning/increment_queue.h"

namespace thin {
namespace {

// Of annealing, found by trial on synthetic soundings: the temperature falls from what a retained observation has of
// the error to a small share of that, and a few swaps go far, since density must move too.
constexpr double kTrialsPerObservation = 20;
constexpr double kColdest = 0.03;
constexpr double kFarShare = 0.05;

bool may_replace(const SwapRules& rules, std::uint32_t out, std::uint32_t in) {
  return rules.priority.empty() || rules.priority[in] >= rules.priority[out];
}

template <class Sums>
bool stands_apart(const Sums& sums, const SwapRules& rules, std::uint32_t in, std::uint32_t out) {
  if (!rules.separation) return true;
  for (const std::uint32_t near : rules.separation->too_near_to(in))
    if (near != out && sums.is_retained(near)) return false;
  return true;
}

// Both queues over tracked sums. An observation that may not be retained beside the present ones is left out of the
// insertions until the next exchange succeeds.
template <class Sums>
class Exchange {
 public:
  Exchange(Sums& sums, const SwapRules& rules)
      : sums_(sums), rules_(rules), removals_(sums, Update::full), insertions_(sums, Update::full) {
    for (std::uint32_t p = 0; p < sums.observation_count(); ++p) (sums.is_retained(p) ? removals_ : insertions_).add(p);
  }

  // One exchange that lowers |Q| E by more than `gain`; false where there is none, and nothing is changed.
  bool step(double gain) { return insert_then_remove(gain) || remove_then_insert(gain); }

 private:
  bool insert_then_remove(double gain) {
    if (insertions_.empty() || removals_.empty()) return false;
    const std::uint32_t in = insertions_.cheapest();
    const double added = insertions_.cheapest_increment();
    if (added >= 0) return false;
    flip(in);
    const std::uint32_t out = removals_.cheapest();
    if (is_good(out, in, added + removals_.cheapest_increment(), gain)) return flip(out), true;
    return flip(in), false;
  }

  bool remove_then_insert(double gain) {
    if (insertions_.empty() || removals_.empty()) return false;
    const std::uint32_t out = removals_.cheapest();
    const double added = removals_.cheapest_increment();
    flip(out);
    const std::uint32_t in = insertions_.cheapest();
    if (is_good(out, in, added + insertions_.cheapest_increment(), gain)) return flip(in), true;
    return flip(out), false;
  }

  bool is_good(std::uint32_t out, std::uint32_t in, double added, double gain) const {
    return out != in && added < -gain && may_replace(rules_, out, in) && stands_apart(sums_, rules_, in, out);
  }

  void flip(std::uint32_t p) {
    IncrementQueue<Sums>& from = sums_.is_retained(p) ? removals_ : insertions_;
    IncrementQueue<Sums>& to = sums_.is_retained(p) ? insertions_ : removals_;
    from.drop(p);
    sums_.change_state(p);
    to.add(p);
    removals_.heed_fallen();
    insertions_.heed_fallen();
  }

  Sums& sums_;
  const SwapRules& rules_;
  IncrementQueue<Sums> removals_, insertions_;
};

// Numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  // 0 .. count-1
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(share() * static_cast<double>(count)); }
  // [0, 1)
  double share() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

// As many as are retained now, anywhere that the rules allow.
std::vector<std::uint32_t> random_set(const EstimationSums& sums, const SwapRules& rules, Random& random) {
  std::vector<std::uint32_t> order(sums.observation_count());
  for (std::uint32_t p = 0; p < order.size(); ++p) order[p] = p;
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  if (!rules.priority.empty())
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return rules.priority[a] > rules.priority[b]; });
  std::vector<std::uint8_t> is_chosen(order.size(), 0);
  std::vector<std::uint32_t> chosen;
  for (const std::uint32_t p : order) {
    if (chosen.size() == sums.retained_count()) break;
    bool is_free = true;
    if (rules.separation)
      for (const std::uint32_t near : rules.separation->too_near_to(p)) is_free = is_free && !is_chosen[near];
    if (!is_free) continue;
    is_chosen[p] = 1;
    chosen.push_back(p);
  }
  return chosen;
}

// Sets the state of `sums` to exactly these.
void retain_exactly(EstimationSums& sums, const std::vector<std::uint32_t>& wanted) {
  std::vector<std::uint8_t> is_wanted(sums.observation_count(), 0);
  for (const std::uint32_t p : wanted) is_wanted[p] = 1;
  for (std::uint32_t p = 0; p < sums.observation_count(); ++p)
    if (sums.is_retained(p) != static_cast<bool>(is_wanted[p])) sums.change_state(p);
}

}  // namespace

void RefinementOptions::declare(OptionTable& table) {
  table.add_choice(
      "refine", refine,
      std::vector<std::pair<std::string, Refinement>>{
          {"none", Refinement::none}, {"exchange", Refinement::exchange}, {"annealing", Refinement::annealing}},
      {.explanation = "after the greedy choice, swap retained against other observations while the "
                      "estimation error falls: the best pair at a time, or first many random ones"});
  table.add("starts", starts,
            {.minimum = 1,
             .maximum = 1000,
             .explanation = "of the refinement: from the greedy set, then from so many less one random ones; the best "
                            "result is taken"});
  table.add("seed", seed, {.explanation = "of random swaps and starts: the same seed gives the same result"});
  table.add("effort", effort,
            {.minimum = 0, .maximum = 1000, .explanation = "of annealing: in proportion to it grow its trials"});
}

template <class Sums>
std::size_t exchange(Sums& sums, const SwapRules& rules, double least_gain) {
  const double gain = least_gain * (1 + sums.error_sum());
  sums.track(EstimationSums::Track::both);
  Exchange exchange(sums, rules);
  std::size_t swaps = 0;
  while (exchange.step(gain)) ++swaps;
  sums.track(EstimationSums::Track::nothing);
  return swaps;
}

template std::size_t exchange(EstimationSums&, const SwapRules&, double);
template std::size_t exchange(LocalAnalysis&, const SwapRules&, double);

void anneal(EstimationSums& sums, const SwapRules& rules, std::uint64_t trials, std::uint64_t seed) {
  std::vector<std::uint32_t> retained = sums.retained();
  const std::size_t n = sums.observation_count();
  if (retained.empty() || retained.size() == n || trials == 0) return;
  const std::vector<std::uint32_t> before = retained;
  const double error_before = sums.error_sum();
  Random random(seed);
  double temperature = error_before / static_cast<double>(retained.size());
  const double cooling = std::pow(kColdest, 1 / static_cast<double>(trials));
  for (std::uint64_t trial = 0; trial < trials; ++trial, temperature *= cooling) {
    const std::size_t place = random.below(retained.size());
    const std::uint32_t out = retained[place];
    const std::uint32_t in = random.share() < kFarShare ? static_cast<std::uint32_t>(random.below(n))
                                                        : sums.observation_near(out, random.share(), random.share());
    if (sums.is_retained(in) || !may_replace(rules, out, in) || !stands_apart(sums, rules, in, out)) continue;
    const double added = sums.swap_increment(out, in);
    if (added >= 0 && random.share() >= std::exp(-added / temperature)) continue;
    sums.change_state(out);
    sums.change_state(in);
    retained[place] = in;
  }
  if (sums.error_sum() > error_before) retain_exactly(sums, before);
}

void refine(EstimationSums& sums, const SwapRules& rules, const RefinementOptions& options) {
  if (options.refine == Refinement::none) return;
  sums.track(EstimationSums::Track::nothing);
  const auto trials = static_cast<std::uint64_t>(options.effort * kTrialsPerObservation *
                                                 static_cast<double>(sums.observation_count()));
  Random random(static_cast<std::uint64_t>(options.seed));
  std::vector<std::uint32_t> best;
  double least = 0;
  for (int start = 0; start < options.starts; ++start) {
    if (start > 0) {
      std::vector<std::uint32_t> set = random_set(sums, rules, random);
      // Where the separation lets a random set not grow to the number asked for, it is no rival.
      if (set.size() < sums.retained_count()) continue;
      retain_exactly(sums, set);
    }
    if (options.refine == Refinement::annealing)
      anneal(sums, rules, trials, static_cast<std::uint64_t>(options.seed) + static_cast<std::uint64_t>(start));
    exchange(sums, rules);
    const double error_sum = sums.error_sum();
    if (start > 0 && error_sum >= least) continue;
    least = error_sum;
    best = sums.retained();
  }
  retain_exactly(sums, best);
}

}  // namespace thin
