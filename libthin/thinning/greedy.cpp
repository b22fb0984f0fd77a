#include "libthin/thinning/greedy.h"

#include <algorithm>
#include <cassert>
#include <functional>

namespace thin {
namespace {

// Observations of equal priority, in the order in which they come to be taken.
std::vector<std::vector<std::uint32_t>> strata(std::size_t n, std::span<const double> priority, bool lowest_first) {
  std::vector<std::uint32_t> all(n);
  for (std::uint32_t p = 0; p < n; ++p) all[p] = p;
  if (priority.empty()) return {all};
  std::stable_sort(all.begin(), all.end(), [&](std::uint32_t a, std::uint32_t b) {
    return lowest_first ? priority[a] < priority[b] : priority[a] > priority[b];
  });
  std::vector<std::vector<std::uint32_t>> result;
  for (const std::uint32_t p : all) {
    if (result.empty() || priority[result.back().front()] != priority[p]) result.emplace_back();
    result.back().push_back(p);
  }
  return result;
}

// The cheapest of a stratum, taken one after the other.
template <class Sums>
class Candidates {
 public:
  Candidates(Sums& sums, Update update) : sums_(sums), queue_(sums, update) {}

  void add(std::uint32_t p) { queue_.add(p); }
  void drop(std::uint32_t p) { queue_.drop(p); }
  bool empty() const { return queue_.empty(); }
  std::uint32_t cheapest() { return queue_.cheapest(); }
  double cheapest_increment() const { return queue_.cheapest_increment(); }

  // Changes the state of p, the cheapest.
  void take(std::uint32_t p) {
    queue_.drop(p);
    sums_.change_state(p);
    queue_.heed_fallen();
  }

 private:
  Sums& sums_;
  IncrementQueue<Sums> queue_;
};

// The error as the steps move it.
class ErrorLimit {
 public:
  template <class Sums>
  ErrorLimit(const Sums& sums, std::optional<double> limit) : limit_(limit) {
    if (limit) error_sum_ = sums.error_sum();
  }
  bool is_passed_by(double increment) const { return limit_ && error_sum_ + increment > *limit_; }
  bool is_met() const { return limit_ && error_sum_ <= *limit_; }
  void move(double increment) { error_sum_ += increment; }

 private:
  std::optional<double> limit_;
  double error_sum_ = 0;
};

// Of the retained, how many each one stands too near to.
class Crowding {
 public:
  Crowding(const EstimationSums& sums, const Separation& separation) : separation_(separation) {
    counts_.assign(sums.observation_count(), 0);
    for (std::uint32_t p = 0; p < counts_.size(); ++p)
      counts_[p] = static_cast<std::uint32_t>(separation.too_near_to(p).size());
  }
  bool is_crowded(std::uint32_t p) const { return counts_[p] > 0; }
  void remove(std::uint32_t p, const std::function<void(std::uint32_t)>& freed) {
    for (const std::uint32_t other : separation_.too_near_to(p))
      if (--counts_[other] == 0) freed(other);
  }

 private:
  const Separation& separation_;
  std::vector<std::uint32_t> counts_;
};

void remove_crowded(EstimationSums& sums, const GreedyGoal& goal, Update update,
                    const std::vector<std::vector<std::uint32_t>>& order_of_strata, std::vector<std::uint32_t>* order) {
  Crowding crowding(sums, *goal.separation);
  for (const auto& stratum : order_of_strata) {
    Candidates candidates(sums, update);
    for (const std::uint32_t p : stratum)
      if (crowding.is_crowded(p)) candidates.add(p);
    while (!candidates.empty()) {
      const std::uint32_t p = candidates.cheapest();
      candidates.take(p);
      if (order) order->push_back(p);
      crowding.remove(p, [&](std::uint32_t freed) { candidates.drop(freed); });
    }
  }
}

}  // namespace

void remove_greedily(EstimationSums& sums, const GreedyGoal& goal, Update update, std::vector<std::uint32_t>* order) {
  if (update == Update::full)
    sums.track(EstimationSums::Track::retained);
  else
    sums.compute_increments();
  const auto order_of_strata = strata(sums.observation_count(), goal.priority, true);
  if (goal.separation && goal.separation->is_demanded()) remove_crowded(sums, goal, update, order_of_strata, order);
  ErrorLimit limit(sums, goal.error_sum);
  for (const auto& stratum : order_of_strata) {
    Candidates candidates(sums, update);
    for (const std::uint32_t p : stratum)
      if (sums.is_retained(p)) candidates.add(p);
    while (!candidates.empty() && sums.retained_count() > goal.retain_count) {
      const std::uint32_t p = candidates.cheapest();
      if (limit.is_passed_by(candidates.cheapest_increment())) return;
      limit.move(candidates.cheapest_increment());
      candidates.take(p);
      if (order) order->push_back(p);
    }
  }
}

template <class Sums>
void insert_greedily(Sums& sums, const GreedyGoal& goal, Update update, std::vector<std::uint32_t>* order) {
  if (update == Update::full)
    sums.track(EstimationSums::Track::given_up);
  else
    sums.compute_increments();
  ErrorLimit limit(sums, goal.error_sum);
  std::vector<std::uint8_t> too_near(sums.observation_count(), 0);
  for (const auto& stratum : strata(sums.observation_count(), goal.priority, false)) {
    Candidates candidates(sums, update);
    for (const std::uint32_t p : stratum)
      if (!too_near[p]) candidates.add(p);
    while (!candidates.empty() && sums.retained_count() < goal.retain_count && !limit.is_met()) {
      const std::uint32_t p = candidates.cheapest();
      limit.move(candidates.cheapest_increment());
      candidates.take(p);
      if (order) order->push_back(p);
      if (!goal.separation) continue;
      for (const std::uint32_t other : goal.separation->too_near_to(p)) {
        too_near[other] = 1;
        candidates.drop(other);
      }
    }
  }
}

template void insert_greedily(EstimationSums&, const GreedyGoal&, Update, std::vector<std::uint32_t>*);
template void insert_greedily(LocalAnalysis&, const GreedyGoal&, Update, std::vector<std::uint32_t>*);

}  // namespace thin
