#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <string_view>

namespace tessera {

/// Lines on their way to the terminal: a bounded queue whose writers wait neither for each other nor for
/// the reader. (Vyukov's queue: each slot has a counter `turn`, which says who may use it.)
///
/// Threads: push any, pop one.
template <std::size_t Slots, std::size_t Bytes>
class LineRing {
  static_assert((Slots & (Slots - 1)) == 0);

 public:
  LineRing() {
    for (std::size_t index = 0; index < Slots; ++index) slots_[index].turn = index;
  }

  /// false: the queue is full. A line that is too long is cut.
  [[nodiscard]] bool push(std::string_view line) {
    std::uint64_t at = pushed_.load(std::memory_order_relaxed);
    for (;;) {
      Slot& slot = slots_[at % Slots];
      const std::uint64_t turn = slot.turn.load(std::memory_order_acquire);
      if (turn < at) return false;
      if (turn > at) {
        at = pushed_.load(std::memory_order_relaxed);
      } else if (pushed_.compare_exchange_weak(at, at + 1, std::memory_order_relaxed)) {
        slot.size = std::min(line.size(), Bytes);
        std::copy_n(line.data(), slot.size, slot.bytes.data());
        if (line.size() > Bytes) slot.bytes[Bytes - 1] = '\n';
        slot.turn.store(at + 1, std::memory_order_release);
        return true;
      }
    }
  }

  /// The oldest line; empty: there is none. It stays valid until `pop`.
  [[nodiscard]] std::string_view front() const {
    const Slot& slot = slots_[popped_ % Slots];
    if (slot.turn.load(std::memory_order_acquire) != popped_ + 1) return {};
    return {slot.bytes.data(), slot.size};
  }
  void pop() {
    slots_[popped_ % Slots].turn.store(popped_ + Slots, std::memory_order_release);
    popped_.fetch_add(1, std::memory_order_release);
  }

  /// The approximate number of lines.
  [[nodiscard]] std::uint64_t size() const {
    const std::uint64_t popped = popped_.load(std::memory_order_acquire);
    return std::max(pushed_.load(std::memory_order_acquire), popped) - popped;
  }

 private:
  struct Slot {
    std::atomic<std::uint64_t> turn{0};
    std::size_t size = 0;
    std::array<char, Bytes> bytes{};
  };
  std::array<Slot, Slots> slots_;
  alignas(64) std::atomic<std::uint64_t> pushed_{0};
  alignas(64) std::atomic<std::uint64_t> popped_{0};
};

}  // namespace tessera
