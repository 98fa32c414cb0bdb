#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tessera/tables.hpp"
#include "waker.hpp"

namespace tessera {

/// The fused places of one channel as one atomic word, and the memory the two sides share.
///
/// The word holds: the marking (a bit per fused place), what each side waits for (a bit per *need*), which
/// side fired last, and a version that every firing raises. A need is a set of fused places that some
/// transition of a side takes from, together. Every firing of a transition that touches the channel is one
/// compare-and-swap:
///
///     (marking & need) == need   ->   (marking & ~need) | produced
///
/// *No wake-up is lost.* A side that can fire nothing registers the needs it waits for by a compare-and-swap
/// that is refused when, in the very word it replaces, one of them may be taken. So every later change of the
/// word sees the registration, and whoever makes a change after which a registered need may be taken wakes
/// that side: a firing (it changes the marking and who fired last) and a registration that shrinks (it may
/// release the other side, see below). Nothing else can make a need takeable.
///
/// *Fairness.* A side that fired last does not take again while the other is registered for a need that is
/// met; it registers itself instead. This cannot block: the two sides cannot both be the last to fire, so the
/// registered side may take; it has been woken by the change that met its need (above); it either takes,
/// after which it is the one that fired last and the first side is woken, or it takes another way and
/// withdraws the registration (before it runs any user code), which wakes the first side too. Transitions
/// that only give are never held back. A registration names needs exactly, not their union, because a side
/// must not be held back for a need that is met in part.
///
/// The memory has one or more slots; each belongs to whoever has taken the token the net protects it with.
/// That token passes through the word, whose compare-and-swaps acquire and release, so the bytes need no
/// atomics.
///
/// Threads: one thread per side; `connect` before they start.
class alignas(64) SharedChannel {
 public:
  static constexpr std::size_t max_places = 10;
  static constexpr std::size_t max_needs = 10;  ///< different ones, per side

  SharedChannel(std::uint32_t marking, std::size_t value_bytes, std::size_t slots = 1);

  /// needs: what that side's transitions take, as sets of bits; nobody is woken when `waker` is nullptr.
  void connect(Side side, Waker* waker, std::uint32_t instance, std::vector<std::uint16_t> needs);

  /// Takes needs[need] (no_need: nothing) and gives `produced`. 0: not now. Otherwise the version that this
  /// firing made, and the registration of `side` is void.
  [[nodiscard]] std::uint32_t fire(Side side, std::uint8_t need, std::uint16_t produced);
  static constexpr std::uint8_t no_need = 0xff;

  /// Registers exactly `wants` (bit i: needs[i]; 0 withdraws). false: one of them may be taken now; nothing
  /// changed.
  [[nodiscard]] bool wait(Side side, std::uint16_t wants);

  /// A value in transit.
  struct Memory {
    std::vector<std::byte> bytes;
    Time stamp{};
    std::uint64_t sequence = 0;  ///< of the write that left it; 0: none yet
    bool valid = false;
  };
  /// Only while the calling side holds the token that protects the slot.
  [[nodiscard]] Memory& memory(std::size_t slot = 0) { return slots_[slot]; }
  [[nodiscard]] std::size_t slots() const { return slots_.size(); }
  /// Counts the writes to all slots, from 1. Only for the sender.
  [[nodiscard]] std::uint64_t next_sequence() { return ++writes_; }

  [[nodiscard]] std::uint16_t marking() const;

 private:
  struct Word;
  struct Party {
    Waker* waker = nullptr;
    std::uint32_t instance = 0;
    std::vector<std::uint16_t> needs;
  };
  [[nodiscard]] bool may_take(Word word, Side side, std::uint16_t need) const;
  [[nodiscard]] bool waits_for_met_need(Word word, Side side) const;
  [[nodiscard]] bool must_yield(Word word, Side side) const;
  void wake_if_ready(Word word, Side side);
  [[nodiscard]] const Party& party(Side side) const { return parties_[static_cast<std::size_t>(side)]; }

  std::atomic<std::uint64_t> word_;
  std::array<Party, 2> parties_;
  std::vector<Memory> slots_;
  std::uint64_t writes_ = 0;  // the sender's own
};

}  // namespace tessera
