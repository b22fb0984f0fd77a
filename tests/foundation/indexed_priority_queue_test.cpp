#include "libthin/foundation/indexed_priority_queue.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace thin {
namespace {

// The oracle: a sorted set of (key, item).
class SlowQueue {
 public:
  void push(std::uint32_t item, double key) { set_.insert({key, item}), keys_[item] = key; }
  void erase(std::uint32_t item) { set_.erase({keys_[item], item}), keys_.erase(item); }
  void update(std::uint32_t item, double key) { erase(item), push(item, key); }
  std::uint32_t top() const { return set_.begin()->second; }
  bool contains(std::uint32_t item) const { return keys_.contains(item); }
  std::size_t size() const { return set_.size(); }

 private:
  std::set<std::pair<double, std::uint32_t>> set_;
  std::map<std::uint32_t, double> keys_;
};

TEST(IndexedPriorityQueue, AgreesWithASortedSetUnderRandomOperations) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::uint32_t capacity = 1 + seed * 7;
    IndexedPriorityQueue<double> queue(capacity);
    SlowQueue slow;
    for (int step = 0; step < 3000; ++step) {
      const std::uint32_t item = static_cast<std::uint32_t>(random() % capacity);
      const double key = static_cast<double>(random() % 10);  // many ties
      if (!queue.contains(item)) {
        queue.push(item, key), slow.push(item, key);
      } else if (random() % 3 == 0) {
        queue.erase(item), slow.erase(item);
      } else {
        queue.update(item, key), slow.update(item, key);
      }
      ASSERT_EQ(queue.size(), slow.size());
      ASSERT_EQ(queue.contains(item), slow.contains(item));
      if (!queue.empty()) {
        ASSERT_EQ(queue.top(), slow.top());
      }
    }
    while (!queue.empty()) {
      const std::uint32_t expected = slow.top();
      slow.erase(expected);
      ASSERT_EQ(queue.pop(), expected);
    }
  }
}

TEST(IndexedPriorityQueue, BuiltAtOnceComesOutInOrder) {
  for (std::size_t n = 0; n < 70; ++n) {
    std::mt19937 random(static_cast<unsigned>(n));
    std::vector<double> keys(n);
    for (double& key : keys) key = static_cast<double>(random() % 7);
    IndexedPriorityQueue<double> queue(keys);
    std::pair<double, std::uint32_t> last{-1, 0};
    for (std::size_t i = 0; i < n; ++i) {
      const std::pair<double, std::uint32_t> next{queue.top_key(), queue.top()};
      EXPECT_EQ(next.first, keys[next.second]);
      EXPECT_LT(last, next);
      last = next;
      queue.pop();
    }
    EXPECT_TRUE(queue.empty());
  }
}

TEST(IndexedPriorityQueue, EqualKeysComeOutByItem) {
  IndexedPriorityQueue<double> queue(5);
  for (const std::uint32_t item : {3U, 1U, 4U, 0U, 2U}) queue.push(item, 1.0);
  for (std::uint32_t item = 0; item < 5; ++item) EXPECT_EQ(queue.pop(), item);
}

}  // namespace
}  // namespace thin
