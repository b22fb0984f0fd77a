#pragma once

// Loops over all cores, by oneTBB behind a header that does not name it. Bodies must write to disjoint places: then the
// result does not depend on the number of threads.

#include <cstddef>
#include <functional>
#include <memory>

namespace thin {

// Calls body(begin, end) for disjoint ranges that together cover [0, count), each at most about `grain` long. Loops may
// be nested: no thread works on more than one range of the outer loop at a time.
void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

// Limits all parallel loops to `count` threads while it lives; 0 means as many as there are cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int count);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace thin
