#include "libthin/foundation/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace thin {
namespace {

TEST(ParallelRanges, CoversEveryPlaceOnce) {
  for (const std::size_t count : {0U, 1U, 999U, 10000U}) {
    std::vector<std::atomic<int>> visits(count);
    parallel_ranges(count, 7, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& visit : visits) EXPECT_EQ(visit, 1);
  }
}

TEST(ThreadLimit, OneMeansThisThreadAlone) {
  const ThreadLimit limit(1);
  std::mutex mutex;
  std::set<std::thread::id> threads;
  parallel_ranges(1000, 1, [&](std::size_t, std::size_t) {
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

}  // namespace
}  // namespace thin
