#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "tessera/ids.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The deadlines at which subsystems are woken: a binary heap that knows the position of each entry, so
/// that a deadline can be changed. Ties are ordered by index. No allocation after construction.
class DeadlineQueue {
 public:
  explicit DeadlineQueue(std::uint32_t size) : times_(size, Time::max()), positions_(size) {
    heap_.reserve(size);
  }

  [[nodiscard]] bool empty() const { return heap_.empty(); }
  [[nodiscard]] std::uint32_t first() const { return heap_.front(); }
  [[nodiscard]] Time first_time() const { return times_[heap_.front()]; }

  /// Time::max() removes the entry.
  void set(std::uint32_t index, Time time) {
    if (!positions_[index].valid()) {
      if (time == Time::max()) return;
      positions_[index] = {static_cast<std::uint32_t>(heap_.size())};
      heap_.push_back(index);
    }
    times_[index] = time;
    if (time == Time::max())
      remove(positions_[index].value);
    else
      sink(rise(positions_[index].value));
  }

 private:
  using Position = Id<struct PositionTag>;  // in heap_
  [[nodiscard]] bool before(std::uint32_t a, std::uint32_t b) const {
    return std::pair(times_[heap_[a]], heap_[a]) < std::pair(times_[heap_[b]], heap_[b]);
  }
  void swap(std::uint32_t a, std::uint32_t b) {
    std::swap(heap_[a], heap_[b]);
    positions_[heap_[a]] = {a};
    positions_[heap_[b]] = {b};
  }
  std::uint32_t rise(std::uint32_t at) {
    for (; at > 0 && before(at, (at - 1) / 2); at = (at - 1) / 2) swap(at, (at - 1) / 2);
    return at;
  }
  void sink(std::uint32_t at) {
    for (;;) {
      std::uint32_t least = at;
      for (std::uint32_t child = 2 * at + 1; child <= 2 * at + 2 && child < heap_.size(); ++child)
        if (before(child, least)) least = child;
      if (least == at) return;
      swap(at, least);
      at = least;
    }
  }
  void remove(std::uint32_t at) {
    const std::uint32_t index = heap_[at];
    swap(at, static_cast<std::uint32_t>(heap_.size() - 1));
    heap_.pop_back();
    positions_[index] = {};
    if (at < heap_.size()) sink(rise(at));
  }

  std::vector<Time> times_;
  std::vector<Position> positions_;
  std::vector<std::uint32_t> heap_;
};

}  // namespace tessera
