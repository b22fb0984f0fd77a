#pragma once

// Observations by what changing their state would add to the error, the cheapest first.
//
// A queued key may lie below the increment that it stands for, never above it (but for lazy updating): what comes to
// the front is made right there, and is the cheapest only if it stays in front. So rises, which are most of the
// changes, cost nothing until then, and the choice is still the true minimum. Equal ones come by index.

#include <cstdint>
#include <limits>
#include <vector>

#include "libthin/foundation/indexed_priority_queue.h"

namespace thin {

enum class Update {
  full,  // every increment that a step changed is made right before the next choice: each step is the true minimum
  lazy,  // an increment is made right only when its observation reaches the front of the queue (thesis 6.4.2)
};

template <class Sums>  // EstimationSums, LocalAnalysis
class IncrementQueue {
 public:
  // `sums` must track the increments of what is queued, or with lazy updating have computed them all at first.
  IncrementQueue(const Sums& sums, Update update)
      : sums_(sums), update_(update), queue_(sums.observation_count()), keys_(sums.observation_count(), kAbsent) {
    if (update == Update::lazy) valid_at_.assign(sums.observation_count(), 0);
  }

  bool empty() const { return queue_.empty(); }

  void add(std::uint32_t p) {
    const bool is_known = update_ == Update::full || sums_.step() == 0;
    keys_[p] = is_known ? sums_.tracked_increment(p) : sums_.increment(p);
    queue_.push(p, keys_[p]);
    if (update_ == Update::lazy) valid_at_[p] = sums_.step();
  }
  void drop(std::uint32_t p) {
    if (!queue_.contains(p)) return;
    queue_.erase(p);
    keys_[p] = kAbsent;
  }

  // REQUIRES: !empty()
  std::uint32_t cheapest() {
    while (!front_is_right()) {
    }
    return queue_.top();
  }
  // Of the last cheapest().
  double cheapest_increment() const { return queue_.top_key(); }

  // After a change of state, with full updating: makes the keys of those right whose increments fell below them.
  void heed_fallen() {
    for (const std::uint32_t p : sums_.fallen())
      if (sums_.tracked_increment(p) < keys_[p]) requeue(p, sums_.tracked_increment(p));
  }

 private:
  bool front_is_right() {
    const std::uint32_t front = queue_.top();
    if (update_ == Update::full) {
      if (queue_.top_key() == sums_.tracked_increment(front)) return true;
      requeue(front, sums_.tracked_increment(front));
      return false;
    }
    if (!sums_.changed_since(front, valid_at_[front])) return true;
    valid_at_[front] = sums_.step();
    requeue(front, sums_.increment(front));
    return false;
  }

  void requeue(std::uint32_t p, double key) {
    queue_.update(p, key);
    keys_[p] = key;
  }

  static constexpr double kAbsent = -std::numeric_limits<double>::infinity();

  const Sums& sums_;
  Update update_;
  IndexedPriorityQueue<double> queue_;
  std::vector<double> keys_;             // the queue's, where they are found faster; kAbsent for what is not queued
  std::vector<std::uint32_t> valid_at_;  // lazy: the step at which each queued increment was computed
};

}  // namespace thin
