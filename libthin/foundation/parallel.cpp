#include "libthin/foundation/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace thin {

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  // Isolated: a thread that waits for this loop's end takes no task of a loop around it, which could be large.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, std::max<std::size_t>(grain, 1)),
                      [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
  });
}

// Made in its place: a global_control can be copied, but the limit ends with the first of the copies.
struct ThreadLimit::Control {
  explicit Control(std::size_t count) : limit(tbb::global_control::max_allowed_parallelism, count) {}
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int count) {
  if (count > 0) control_ = std::make_unique<Control>(static_cast<std::size_t>(count));
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace thin
