#include "shared_channel.hpp"

#include <cassert>
#include <utility>

namespace tessera {
namespace {

[[nodiscard]] constexpr Side other(Side side) { return side == Side::send ? Side::receive : Side::send; }

}  // namespace

/// Bits 0-9 marking, 10-19 wants of the sender, 20-29 wants of the receiver, 30-31 who fired last, 32-63
/// version.
struct SharedChannel::Word {
  std::uint64_t bits = 0;

  static constexpr std::uint64_t field = (1U << max_places) - 1;
  [[nodiscard]] static constexpr unsigned wants_shift(Side side) { return side == Side::send ? 10 : 20; }
  [[nodiscard]] static constexpr std::uint64_t mark_of(Side side) { return side == Side::send ? 1 : 2; }

  [[nodiscard]] std::uint16_t marking() const { return static_cast<std::uint16_t>(bits & field); }
  [[nodiscard]] std::uint16_t wants(Side side) const {
    return static_cast<std::uint16_t>(bits >> wants_shift(side) & field);
  }
  [[nodiscard]] bool last_was(Side side) const { return (bits >> 30 & 3U) == mark_of(side); }
  [[nodiscard]] std::uint32_t version() const { return static_cast<std::uint32_t>(bits >> 32); }

  [[nodiscard]] Word with_wants(Side side, std::uint16_t wants) const {
    return {(bits & ~(field << wants_shift(side))) | static_cast<std::uint64_t>(wants) << wants_shift(side)};
  }
  [[nodiscard]] Word after_firing(Side side, std::uint16_t taken, std::uint16_t given) const {
    std::uint32_t next = version() + 1;
    if (next == 0) next = 1;  // 0 means "no channel" in a recording
    const auto marked = static_cast<std::uint64_t>((marking() & ~taken) | given);
    const std::uint64_t wanted = with_wants(side, 0).bits & (field << 10 | field << 20);
    return {static_cast<std::uint64_t>(next) << 32 | mark_of(side) << 30 | wanted | marked};
  }
};

SharedChannel::SharedChannel(std::uint32_t marking, std::size_t value_bytes, std::size_t slots)
    : word_(marking), slots_(slots) {
  assert(marking <= Word::field);
  for (Memory& memory : slots_) memory.bytes.resize(value_bytes);
}

void SharedChannel::connect(Side side, Waker* waker, std::uint32_t instance,
                            std::vector<std::uint16_t> needs) {
  assert(needs.size() <= max_needs);
  parties_[static_cast<std::size_t>(side)] = {waker, instance, std::move(needs)};
}

std::uint32_t SharedChannel::fire(Side side, std::uint8_t need, std::uint16_t produced) {
  const std::uint16_t taken = need == no_need ? std::uint16_t{0} : party(side).needs[need];
  Word before{word_.load(std::memory_order_acquire)};
  for (;;) {
    if (!may_take(before, side, taken)) return 0;
    assert((before.marking() & ~taken & produced) == 0 && "the net is not safe");
    const Word after = before.after_firing(side, taken, produced);
    if (word_.compare_exchange_weak(before.bits, after.bits, std::memory_order_acq_rel,
                                    std::memory_order_acquire)) {
      wake_if_ready(after, other(side));
      return after.version();
    }
  }
}

bool SharedChannel::wait(Side side, std::uint16_t wants) {
  Word before{word_.load(std::memory_order_acquire)};
  for (;;) {
    const Word after = before.with_wants(side, wants);
    if (waits_for_met_need(after, side) && !must_yield(after, side)) return false;
    if (after.bits == before.bits) return true;
    if (word_.compare_exchange_weak(before.bits, after.bits, std::memory_order_acq_rel,
                                    std::memory_order_acquire)) {
      wake_if_ready(after, other(side));
      return true;
    }
  }
}

std::uint16_t SharedChannel::marking() const { return Word{word_.load(std::memory_order_acquire)}.marking(); }

bool SharedChannel::may_take(Word word, Side side, std::uint16_t need) const {
  if (need == 0) return true;
  return (word.marking() & need) == need && !must_yield(word, side);
}

bool SharedChannel::waits_for_met_need(Word word, Side side) const {
  const std::vector<std::uint16_t>& needs = party(side).needs;
  const std::uint16_t wants = word.wants(side);
  for (std::size_t need = 0; need < needs.size(); ++need)
    if ((wants >> need & 1) != 0 && (word.marking() & needs[need]) == needs[need]) return true;
  return false;
}

bool SharedChannel::must_yield(Word word, Side side) const {
  return word.last_was(side) && word.wants(other(side)) != 0 && waits_for_met_need(word, other(side));
}

void SharedChannel::wake_if_ready(Word word, Side side) {
  const Party& sleeper = party(side);
  if (sleeper.waker == nullptr || word.wants(side) == 0) return;
  if (waits_for_met_need(word, side) && !must_yield(word, side)) sleeper.waker->wake(sleeper.instance);
}

}  // namespace tessera
