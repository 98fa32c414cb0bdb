#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace tessera {

/// The transitions that wait for their turn, each at most once, in a ring: first come, first served. The
/// object can be copied; the ring belongs to its maker.
class FairTurns {
 public:
  /// ring: its size is a power of two, and at least the number of transitions that can wait.
  explicit FairTurns(std::span<std::uint32_t> ring)
      : ring_(ring.data()), mask_(static_cast<std::uint32_t>(ring.size() - 1)) {}

  [[nodiscard]] bool empty() const { return first_ == end_; }
  void push(std::uint32_t transition) { ring_[end_++ & mask_] = transition; }
  [[nodiscard]] std::uint32_t pop() { return ring_[first_++ & mask_]; }
  /// Moves a waiting transition to the front; the one in front takes its place. choice: below count().
  void bring_forward(std::uint32_t choice) {
    std::swap(ring_[first_ & mask_], ring_[(first_ + choice) & mask_]);
  }
  [[nodiscard]] std::uint32_t count() const { return end_ - first_; }

 private:
  std::uint32_t* ring_;
  std::uint32_t mask_;
  std::uint32_t first_ = 0, end_ = 0;  // modulo 2^32, which is a multiple of the ring's size
};

/// The same with one ring per rank of priority, in random order if requested. The object can be copied.
class RankedTurns {
 public:
  /// rank: per transition. ranks: one ring each. occupied: one bit each, rounded up to words, all 0.
  RankedTurns(std::span<const std::uint32_t> rank, std::span<FairTurns> ranks,
              std::span<std::uint64_t> occupied)
      : rank_(rank.data()), ranks_(ranks.data()), occupied_(occupied) {}

  void draw_lots(std::uint64_t seed) {
    random_ = true;
    state_ = seed;
  }

  [[nodiscard]] bool empty() const { return waiting_ == 0; }
  void push(std::uint32_t transition) {
    const std::uint32_t rank = rank_[transition];
    ranks_[rank].push(transition);
    occupied_[rank / 64] |= std::uint64_t{1} << rank % 64;
    ++waiting_;
  }
  [[nodiscard]] std::uint32_t pop() {
    std::size_t word = 0;
    while (occupied_[word] == 0) ++word;
    const std::size_t rank = word * 64 + static_cast<std::size_t>(std::countr_zero(occupied_[word]));
    FairTurns& turns = ranks_[rank];
    if (random_) turns.bring_forward(below(turns.count()));
    const std::uint32_t transition = turns.pop();
    if (turns.empty()) occupied_[word] &= occupied_[word] - 1;  // its bit is the lowest
    --waiting_;
    return transition;
  }

 private:
  /// splitmix64, scaled: the same on every platform.
  [[nodiscard]] std::uint32_t below(std::uint32_t limit) {
    std::uint64_t mixed = state_ += 0x9e3779b97f4a7c15U;
    mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebU;
    mixed ^= mixed >> 31;
    return static_cast<std::uint32_t>(((mixed >> 32) * limit) >> 32);
  }

  const std::uint32_t* rank_;
  FairTurns* ranks_;
  std::span<std::uint64_t> occupied_;
  std::uint64_t waiting_ = 0, state_ = 0;
  bool random_ = false;
};

}  // namespace tessera
