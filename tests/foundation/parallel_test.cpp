#include "libthin/foundation/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
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

// Those that take a part in a loop long enough for all to wake up.
std::set<std::thread::id> threads_of_a_long_loop() {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  parallel_ranges(200, 1, [&](std::size_t, std::size_t) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(1);
    while (std::chrono::steady_clock::now() < end) {
    }
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  return threads;
}

TEST(ThreadLimit, OneMeansThisThreadAloneWhileItLives) {
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(threads_of_a_long_loop(), std::set{std::this_thread::get_id()});
  }
  if (std::thread::hardware_concurrency() == 1) GTEST_SKIP() << "one core: there is nothing to limit";
  EXPECT_GT(threads_of_a_long_loop().size(), 1U);
}

}  // namespace
}  // namespace thin
