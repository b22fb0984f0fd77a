#pragma once

// Observations by what changing their state would add to the estimation error, the cheapest first.
//
// A queued key may lie below the increment that it stands for, never above it (but for lazy updating): what comes to
// the front is made right there, and is the cheapest only if it stays in front. So rises, which are most of the
// changes, cost nothing until then, and the choice is still the true minimum. Equal ones come by index.

#include <cstdint>
#include <vector>

#include "libthin/estimation/estimation_sums.h"
#include "libthin/foundation/indexed_priority_queue.h"

namespace thin {

enum class Update {
  full,  // every increment that a step changed is made right before the next choice: each step is the true minimum
  lazy,  // an increment is made right only when its observation reaches the front of the queue (thesis 6.4.2)
};

class IncrementQueue {
 public:
  // With full updating `sums` must track the increments of what is queued.
  IncrementQueue(const EstimationSums& sums, Update update)
      : sums_(sums), update_(update), queue_(sums.observation_count()) {
    if (update == Update::lazy) valid_at_.assign(sums.observation_count(), 0);
  }

  bool empty() const { return queue_.empty(); }

  void add(std::uint32_t p) {
    queue_.push(p, update_ == Update::full ? sums_.tracked_increment(p) : sums_.increment(p));
    if (update_ == Update::lazy) valid_at_[p] = sums_.step();
  }
  void drop(std::uint32_t p) {
    if (queue_.contains(p)) queue_.erase(p);
  }

  // REQUIRES: !empty()
  std::uint32_t cheapest() {
    while (!front_is_right()) {
    }
    return queue_.top();
  }
  // Of the last cheapest().
  double cheapest_increment() const { return queue_.top_key(); }

  // After a change of state, with full updating: the observations whose increments it moved.
  void heed(const std::vector<std::uint32_t>& changed) {
    for (const std::uint32_t p : changed)
      if (queue_.contains(p) && sums_.tracked_increment(p) < queue_.key(p))
        queue_.update(p, sums_.tracked_increment(p));
  }

 private:
  bool front_is_right() {
    const std::uint32_t front = queue_.top();
    if (update_ == Update::full) {
      if (queue_.top_key() == sums_.tracked_increment(front)) return true;
      queue_.update(front, sums_.tracked_increment(front));
      return false;
    }
    if (!sums_.changed_since(front, valid_at_[front])) return true;
    valid_at_[front] = sums_.step();
    queue_.update(front, sums_.increment(front));
    return false;
  }

  const EstimationSums& sums_;
  Update update_;
  IndexedPriorityQueue<double> queue_;
  std::vector<std::uint32_t> valid_at_;  // lazy: the step at which each queued increment was computed
};

}  // namespace thin
