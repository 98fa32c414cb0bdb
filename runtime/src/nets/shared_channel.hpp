#pragma once

#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "system/waker.hpp"
#include "tessera/channel_limits.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/tables.hpp"

namespace tessera {

/// The fused places of one channel as one atomic word, and the memory that the two sides share.
///
/// The word holds: the marking (a bit per fused place), what each side waits for (a bit per *need*),
/// which side fired last, and a version that every firing raises. A need is a set of fused places
/// that some transition of a side takes from, together. Every firing of a transition that touches the
/// channel is one compare-and-swap:
///
///     (marking & need) == need   ->   (marking & ~need) | produced
///
/// *No wake-up is lost.* A side that can fire nothing registers the needs that it waits for. It does so
/// by a compare-and-swap that fails if one of the needs may be taken in the very word that it replaces.
/// So every later change of the word sees the registration. If a registered need may be taken after a
/// change, the side that made the change wakes the registered side. Only two changes can have this effect:
/// a firing (it changes the marking and who fired last) and a registration that shrinks (it may release
/// the other side, see below). Nothing else can make a need takeable.
///
/// *Fairness.* A side that has been passed over says so when it registers again: it had registered, was
/// woken, and found that the other side had fired again. From then on, the side that fired last does not take
/// while the other is registered for a need that is met; it registers itself instead. This cannot block. The
/// two sides cannot both be the last to fire, so the registered side may take. It has been woken by the
/// change that met its need (above). Then it either takes, becomes the one that fired last, and wakes the
/// first side; or it takes another way and withdraws the registration (before it runs any user code), which
/// wakes the first side, too. Transitions that only give are never held back. A registration names each need
/// and not their union, because a side must not be held back for a need that is met only in part. The first
/// registration holds no side back. Otherwise two busy sides would sleep and wake each other at every single
/// turn.
///
/// The memory has one or more slots. A slot belongs to the side that has taken the token with which the
/// net protects it. That token passes through the word, whose compare-and-swaps acquire and release, so
/// the bytes need no atomics.
///
/// Threads: one thread per side, or one thread for both, which then needs no compare-and-swap;
///          `connect` before they start.
class alignas(64) SharedChannel {
 public:
  /// type: of the values, if they are more than their bytes. readings: those that stand beside a value.
  SharedChannel(std::uint32_t marking, std::size_t value_bytes, std::size_t slots = 1,
                const ValueType* type = nullptr, std::size_t readings = 0);
  ~SharedChannel();
  SharedChannel(const SharedChannel&) = delete;
  SharedChannel& operator=(const SharedChannel&) = delete;

  /// needs: the sets of fused places that the side's transitions take, as bits.
  /// waker: nullptr wakes no thread.
  void connect(Side side, Waker* waker, std::uint32_t instance, std::vector<std::uint16_t> needs);
  /// Both sides run in one thread.
  void set_single_threaded();

  /// Takes `taken` (one of the needs of that side, as bits, or nothing) and gives `produced`. 0: it cannot
  /// fire now. Otherwise: the version that this firing made; the registration of `side` is removed.
  [[nodiscard]] std::uint32_t fire(Side side, std::uint16_t taken, std::uint16_t produced);

  /// As fire, but only if `still()` holds after the read of the word that the firing replaces. Everything
  /// that the other side has published before that word is visible to `still`. It ignores fairness: it is for
  /// callers that rarely fire.
  template <class Still>
  [[nodiscard]] std::uint32_t fire_if(Side side, std::uint16_t taken, std::uint16_t produced, Still still);

  /// Registers exactly `wants` (bit i: needs[i]; 0 withdraws). A side that is registered already insists on
  /// its turn. false: one of the needs may be taken now, and nothing was changed.
  [[nodiscard]] bool wait(Side side, std::uint16_t wants);

  /// Whether a side has registered, and whether it may take one of the needs for which
  /// it registered. Threads: any.
  enum class Waiting : std::uint8_t { no, in_vain, may_take };
  [[nodiscard]] Waiting waiting(Side side) const {
    const Word word{word_.load(std::memory_order_acquire)};
    if (word.wants(side) == 0) return Waiting::no;
    return waits_for_met_need(word, side) ? Waiting::may_take : Waiting::in_vain;
  }

  /// Whether nothing can be taken before a side gives. With the built-in models this means that the other
  /// side is at the memory, which runs no user code and is soon over.
  [[nodiscard]] bool held() const { return marking() == 0; }
  /// Waits actively until that is over; false: it takes too long.
  [[nodiscard]] bool outwait() const;

  /// A value in transit.
  struct Memory {
    std::vector<std::byte> bytes;  ///< of the value, and of what stands behind it
    Time* readings = nullptr;      ///< on which the value is based (CarriedReadings); behind it
    Time stamp{};
    std::uint64_t sequence = 0;  ///< of the write that stored the value; 0: none yet
    bool valid = false;
  };
  /// Only while the calling side holds the token that protects the slot.
  [[nodiscard]] Memory& memory(std::size_t slot = 0) { return slots_[slot]; }
  [[nodiscard]] std::size_t slots() const { return slots_.size(); }
  /// Counts the writes to all slots, from 1. Only for the sender.
  [[nodiscard]] std::uint64_t next_sequence() { return ++writes_; }

  [[nodiscard]] std::uint16_t marking() const;

 private:
  /// Bits 0-9 marking, 10-19 wants of the sender, 20-29 wants of the receiver, 30 the receiver fired last,
  /// 31 a side insists, 32-63 version.
  struct Word {
    std::uint64_t bits = 0;

    static constexpr std::uint64_t field = (1U << most_shared_places) - 1;
    static constexpr std::uint64_t receiver_last = 1U << 30, insisting = 1U << 31;
    static constexpr std::uint64_t one_version = std::uint64_t{1} << 32;
    [[nodiscard]] static constexpr unsigned wants_shift(Side side) { return side == Side::send ? 10 : 20; }

    [[nodiscard]] std::uint16_t marking() const { return static_cast<std::uint16_t>(bits & field); }
    [[nodiscard]] std::uint16_t wants(Side side) const {
      return static_cast<std::uint16_t>(bits >> wants_shift(side) & field);
    }
    [[nodiscard]] bool last_was(Side side) const {
      return ((bits & receiver_last) != 0) == (side == Side::receive);
    }
    [[nodiscard]] bool insists() const { return (bits & insisting) != 0; }
    [[nodiscard]] std::uint32_t version() const { return static_cast<std::uint32_t>(bits >> 32); }
    [[nodiscard]] Word with_wants(Side side, std::uint16_t wants) const;
    [[nodiscard]] Word after_firing(Side side, std::uint16_t taken, std::uint16_t given) const;
  };
  struct alignas(64) Party {
    std::uint64_t seen = 0;        // the word as this side left or found it; only this side uses it
    bool single_threaded = false;  // the same for both sides; stored here, where reading it costs nothing
    Waker* waker = nullptr;
    std::uint32_t instance = 0;
    std::vector<std::uint16_t> needs;
  };
  [[nodiscard]] static constexpr Side other(Side side) {
    return side == Side::send ? Side::receive : Side::send;
  }
  [[nodiscard]] bool may_take(Word word, Side side, std::uint16_t need) const {
    if (need == 0) return true;
    return (word.marking() & need) == need && !must_yield(word, side);
  }
  [[nodiscard]] bool waits_for_met_need(Word word, Side side) const;
  [[nodiscard]] bool must_yield(Word word, Side side) const {
    return word.insists() && word.last_was(side) && waits_for_met_need(word, other(side));
  }
  void wake_if_ready(Word word, Side side);
  [[nodiscard]] std::uint32_t fire_alone(Side side, std::uint16_t taken, std::uint16_t produced);
  [[nodiscard]] const Party& party(Side side) const { return parties_[static_cast<std::size_t>(side)]; }

  std::atomic<std::uint64_t> word_;  // alone in its cache line; so are the data of each side
  std::array<Party, 2> parties_;
  std::vector<Memory> slots_;
  const ValueType* type_;
  alignas(64) std::uint64_t writes_ = 0;  // used by the sender only
};

/// A bit per place that holds a token at first.
[[nodiscard]] inline std::uint32_t initial_marking(std::span<const FusedPlace> places) {
  std::uint32_t marking = 0;
  for (std::size_t place = 0; place < places.size() && place < most_shared_places; ++place)
    if (places[place].tokens > 0) marking |= 1U << place;
  return marking;
}

inline SharedChannel::Word SharedChannel::Word::with_wants(Side side, std::uint16_t wants) const {
  return {(bits & ~(field << wants_shift(side))) | static_cast<std::uint64_t>(wants) << wants_shift(side)};
}

inline SharedChannel::Word SharedChannel::Word::after_firing(Side side, std::uint16_t taken,
                                                             std::uint16_t given) const {
  std::uint64_t next = bits + one_version;
  if (next < one_version) next += one_version;  // version 0 means "no channel" in a recording
  const std::uint64_t waited = bits & field << wants_shift(side);
  if (waited != 0) next &= ~(waited | insisting);  // the side waits no longer, and has had its turn
  next = (next & ~std::uint64_t{taken}) | given;
  return {side == Side::receive ? next | receiver_last : next & ~receiver_last};
}

/// Starts from the last known word. To load it first would fetch its cache line twice:
/// to read it and to change it.
inline std::uint32_t SharedChannel::fire(Side side, std::uint16_t taken, std::uint16_t produced) {
  Party& own = parties_[static_cast<std::size_t>(side)];
  if (own.single_threaded) return fire_alone(side, taken, produced);
  std::uint64_t& seen = own.seen;
  if (!may_take({seen}, side, taken)) seen = word_.load(std::memory_order_acquire);
  for (;;) {
    const Word before{seen};
    if (!may_take(before, side, taken)) return 0;
    const Word after = before.after_firing(side, taken, produced);
    if (word_.compare_exchange_weak(seen, after.bits, std::memory_order_acq_rel, std::memory_order_acquire)) {
      assert((before.marking() & ~taken & produced) == 0 && "the net is not safe");
      seen = after.bits;
      if (after.wants(other(side)) != 0) wake_if_ready(after, other(side));
      return after.version();
    }
  }
}

template <class Still>
std::uint32_t SharedChannel::fire_if(Side side, std::uint16_t taken, std::uint16_t produced, Still still) {
  Word before{word_.load(std::memory_order_acquire)};
  for (;;) {
    if ((before.marking() & taken) != taken || !still()) return 0;
    const Word after = before.after_firing(side, taken, produced);
    if (!word_.compare_exchange_weak(before.bits, after.bits, std::memory_order_acq_rel,
                                     std::memory_order_acquire))
      continue;
    if (after.wants(other(side)) != 0) wake_if_ready(after, other(side));
    return after.version();
  }
}

inline std::uint32_t SharedChannel::fire_alone(Side side, std::uint16_t taken, std::uint16_t produced) {
  const Word before{word_.load(std::memory_order_relaxed)};
  if (!may_take(before, side, taken)) return 0;
  assert((before.marking() & ~taken & produced) == 0 && "the net is not safe");
  const Word after = before.after_firing(side, taken, produced);
  word_.store(after.bits, std::memory_order_relaxed);
  if (after.wants(other(side)) != 0) wake_if_ready(after, other(side));
  return after.version();
}

inline std::uint16_t SharedChannel::marking() const {
  return Word{word_.load(std::memory_order_acquire)}.marking();
}

}  // namespace tessera
