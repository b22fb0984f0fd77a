#include "libthin/foundation/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace thin {

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  // Now and then a worker that oneTBB has just started takes a range in spite of a limit to one thread.
  if (tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism) < 2) {
    for (std::size_t begin = 0; begin < count; begin += grain) body(begin, std::min(begin + grain, count));
    return;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
}

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int count) {
  if (count > 0)
    control_ = std::make_unique<Control>(
        Control{{tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)}});
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace thin
