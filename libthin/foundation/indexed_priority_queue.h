#pragma once

// Min-queue over the items 0 .. capacity-1, each with a key that may change while it is queued. Equal keys come out in
// the order of their items, so that the order out depends on the keys alone and never on the order in.
//
// A 4-ary heap: push, pop, update and erase are O(log n); top and contains are O(1). Shallower than a binary heap, and
// the four children lie in one or two cache lines.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace thin {

template <class Key = double>
class IndexedPriorityQueue {
 public:
  using Item = std::uint32_t;

  explicit IndexedPriorityQueue(std::size_t capacity = 0) : place_(capacity, kAbsent) {}

  // Queue of all items 0 .. keys.size()-1 at once, O(n).
  explicit IndexedPriorityQueue(const std::vector<Key>& keys) : heap_(keys.size()), place_(keys.size()) {
    for (Item item = 0; item < keys.size(); ++item) set(item, {keys[item], item});
    for (std::size_t place = heap_.size() / kArity + 1; place-- > 0;)
      if (place < heap_.size()) sift_down(place, heap_[place]);
  }

  std::size_t size() const { return heap_.size(); }
  bool empty() const { return heap_.empty(); }
  std::size_t capacity() const { return place_.size(); }
  bool contains(Item item) const { return place_[item] != kAbsent; }

  // REQUIRES: contains(item)
  const Key& key(Item item) const { return assert(contains(item)), heap_[place_[item]].key; }

  // REQUIRES: !empty()
  Item top() const { return assert(!empty()), heap_.front().item; }
  const Key& top_key() const { return assert(!empty()), heap_.front().key; }

  // REQUIRES: !contains(item)
  void push(Item item, Key key) {
    assert(!contains(item));
    heap_.push_back({key, item});
    sift_up(heap_.size() - 1, {key, item});
  }

  // REQUIRES: !empty()
  Item pop() {
    const Item item = top();
    erase(item);
    return item;
  }

  // REQUIRES: contains(item)
  void update(Item item, Key key) {
    assert(contains(item));
    place_entry(place_[item], {key, item});
  }

  // REQUIRES: contains(item)
  void erase(Item item) {
    assert(contains(item));
    const std::size_t place = place_[item];
    const Entry last = heap_.back();
    heap_.pop_back();
    place_[item] = kAbsent;
    if (place < heap_.size()) place_entry(place, last);
  }

 private:
  static constexpr std::size_t kArity = 4;
  static constexpr std::uint32_t kAbsent = std::numeric_limits<std::uint32_t>::max();

  struct Entry {
    Key key;
    Item item;
    bool operator<(const Entry& other) const { return key != other.key ? key < other.key : item < other.item; }
  };

  void set(std::size_t place, const Entry& entry) {
    heap_[place] = entry;
    place_[entry.item] = static_cast<std::uint32_t>(place);
  }

  void place_entry(std::size_t place, const Entry& entry) {
    if (place > 0 && entry < heap_[(place - 1) / kArity])
      sift_up(place, entry);
    else
      sift_down(place, entry);
  }

  void sift_up(std::size_t place, const Entry entry) {
    while (place > 0) {
      const std::size_t parent = (place - 1) / kArity;
      if (!(entry < heap_[parent])) break;
      set(place, heap_[parent]);
      place = parent;
    }
    set(place, entry);
  }

  void sift_down(std::size_t place, const Entry entry) {
    for (;;) {
      const std::size_t first = place * kArity + 1;
      if (first >= heap_.size()) break;
      std::size_t least = first;
      for (std::size_t child = first + 1; child < first + kArity && child < heap_.size(); ++child)
        if (heap_[child] < heap_[least]) least = child;
      if (!(heap_[least] < entry)) break;
      set(place, heap_[least]);
      place = least;
    }
    set(place, entry);
  }

  std::vector<Entry> heap_;
  std::vector<std::uint32_t> place_;  // of each item in heap_, or kAbsent
};

}  // namespace thin
