#include "libthin/thinning/greedy_removal.h"

#include "libthin/foundation/indexed_priority_queue.h"

namespace thin {
namespace {

using Queue = IndexedPriorityQueue<double>;

std::uint32_t take_least_full(RemovalSums& sums, Queue& queue, std::vector<std::uint32_t>& changed) {
  const std::uint32_t least = queue.pop();
  changed.clear();
  sums.remove(least, &changed);
  for (const std::uint32_t p : changed) queue.update(p, sums.tracked_increment(p));
  return least;
}

// valid_at: the step at which the queued increment of each observation was computed.
std::uint32_t take_least_lazy(RemovalSums& sums, Queue& queue, std::vector<std::uint32_t>& valid_at) {
  while (sums.changed_since(queue.top(), valid_at[queue.top()])) {
    const std::uint32_t stale = queue.top();
    valid_at[stale] = sums.step();
    queue.update(stale, sums.increment(stale));
  }
  const std::uint32_t least = queue.pop();
  sums.remove(least);
  return least;
}

}  // namespace

Retained remove_greedily(RemovalSums& sums, std::size_t retain_count, Update update,
                         std::vector<std::uint32_t>* removed) {
  const std::size_t n = sums.observation_count();
  if (update == Update::full) sums.track_increments();
  std::vector<double> increments(n);
  for (std::uint32_t p = 0; p < n; ++p)
    increments[p] = update == Update::full ? sums.tracked_increment(p) : sums.increment(p);

  Queue queue(increments);
  std::vector<std::uint32_t> changed;
  std::vector<std::uint32_t> valid_at(n, 0);
  while (queue.size() > retain_count) {
    const std::uint32_t least =
        update == Update::full ? take_least_full(sums, queue, changed) : take_least_lazy(sums, queue, valid_at);
    if (removed) removed->push_back(least);
  }

  Retained retained;
  for (std::uint32_t p = 0; p < n; ++p)
    if (queue.contains(p)) retained.push_back(p);
  return retained;
}

}  // namespace thin
