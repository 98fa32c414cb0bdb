#include "nets/shared_channel.hpp"

#include <new>
#include <utility>

namespace tessera {
namespace {

/// Some microseconds in all, about the cost of sleeping and being woken. The first pause is long enough for
/// the working side to have a dozen turns in its cache before the two meet again.
constexpr int first_pause = 32, longest_pause = 64;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("isb");
#endif
}

}  // namespace

SharedChannel::SharedChannel(std::uint32_t marking, std::size_t value_bytes, std::size_t slots,
                             const ValueType* type, std::size_t readings)
    : word_(marking), slots_(slots), type_(type) {
  assert(marking <= Word::field);
  for (Memory& memory : slots_) {
    const std::size_t behind = (value_bytes + alignof(Time) - 1) / alignof(Time) * alignof(Time);
    memory.bytes.resize(readings == 0 ? value_bytes : behind + readings * sizeof(Time));
    for (std::size_t index = 0; index < readings; ++index) {
      Time* const reading = new (memory.bytes.data() + behind + index * sizeof(Time)) Time(Time::min());
      if (index == 0) memory.readings = reading;
    }
    if (type_ != nullptr) type_->construct(memory.bytes.data());
  }
}

SharedChannel::~SharedChannel() {
  if (type_ == nullptr) return;
  for (Memory& memory : slots_) type_->destroy(memory.bytes.data());
}

void SharedChannel::connect(Side side, Waker* waker, std::uint32_t instance,
                            std::vector<std::uint16_t> needs) {
  assert(needs.size() <= most_needs);
  Party& party = parties_[static_cast<std::size_t>(side)];
  party.seen = word_.load();
  party.waker = waker;
  party.instance = instance;
  party.needs = std::move(needs);
}

void SharedChannel::set_single_threaded() {
  for (Party& party : parties_) party.single_threaded = true;
}

bool SharedChannel::wait(Side side, std::uint16_t wants) {
  Word before{word_.load(std::memory_order_acquire)};
  for (;;) {
    Word after = before.with_wants(side, wants);
    if (wants != 0 && before.wants(side) != 0) after.bits |= Word::insisting;
    if (wants == 0 && before.wants(side) != 0) after.bits &= ~Word::insisting;
    if (waits_for_met_need(after, side) && !must_yield(after, side)) return false;
    if (after.bits == before.bits) return true;
    if (word_.compare_exchange_weak(before.bits, after.bits, std::memory_order_acq_rel,
                                    std::memory_order_acquire)) {
      wake_if_ready(after, other(side));
      return true;
    }
  }
}

bool SharedChannel::outwait() const {
  for (int pauses = first_pause; pauses <= longest_pause; pauses *= 2) {
    for (int count = 0; count < pauses; ++count) pause();
    if (!held()) return true;
  }
  return false;
}

bool SharedChannel::waits_for_met_need(Word word, Side side) const {
  const std::vector<std::uint16_t>& needs = party(side).needs;
  const std::uint16_t wants = word.wants(side);
  for (std::size_t need = 0; need < needs.size(); ++need)
    if ((wants >> need & 1) != 0 && (word.marking() & needs[need]) == needs[need]) return true;
  return false;
}

void SharedChannel::wake_if_ready(Word word, Side side) {
  const Party& sleeper = party(side);
  if (sleeper.waker == nullptr || word.wants(side) == 0) return;
  if (waits_for_met_need(word, side) && !must_yield(word, side)) sleeper.waker->wake(sleeper.instance);
}

}  // namespace tessera
