#pragma once

#include <optional>

#include "network/messages.hpp"

namespace tessera::network {

/// The decisions of a sender about the state of a receiver. Each decision is one function, so that tests can
/// replace each by a wrong one and expect the protocol to fail.
struct SenderRules {
  /// Late states of an older incarnation of the receiver do not count.
  static bool counts(const State& state, Incarnation peer) { return state.from >= peer; }
  static Incarnation followed(const State& state, Incarnation /*peer*/) { return state.from; }
  /// Data names the receiver it is for, so that no other incarnation reads it.
  static Incarnation target(Incarnation peer) { return peer; }
  /// The newest value of this incarnation was taken. A state about an older value does not say so.
  static bool acknowledges(const State& state, Incarnation me, Number number) {
    return state.peer == me && state.taken == number && number.any();
  }
  static bool ends_repetition(const State& state, Incarnation me, Number number) {
    return acknowledges(state, me, number);
  }
};

/// How a side uses its channel.
enum class Sending : std::uint8_t {
  non_blocking,  ///< write() never waits
  blocking,      ///< waits until the value was taken, or its time is up
  exchange       ///< non-blocking at both ends: a new receiver gets the latest value
};

/// The sender's side of a channel between processes. Its owner keeps the newest value, sends with it the
/// messages that this class asks for, and calls repeat() while repeats() is true (network/repetition.hpp says
/// when).
///
/// Threads: one at a time. No member allocates or throws.
template <class Rules = SenderRules>
class BasicSender {
 public:
  struct Effects {
    std::optional<Data> send{};
    bool taken = false;       ///< a blocking send has ended: its value was taken
    bool superseded = false;  ///< the receiver follows a later incarnation and ignores this one
  };

  BasicSender(Sending mode, Incarnation me) : mode_(mode), me_(me) {}

  /// A new value, which overwrites the one before. Precondition: not waiting().
  Effects write() { return write({number_.value + 1}); }
  /// The same with a number of the caller, who may skip numbers. Precondition: greater than number().
  Effects write(Number number) {
    number_ = number;
    pending_ = true;
    recall_ = false;
    waiting_ = mode_ == Sending::blocking;
    return {.send = data()};
  }

  /// The time of a blocking send is over. The sender does not know whether its value was taken, will be taken
  /// or never will. Precondition: waiting().
  Effects time_is_up() {
    waiting_ = pending_ = false;
    recall_ = true;
    return repeat();
  }

  Effects hear(const State& state) {
    Effects effects;
    effects.superseded = state.peer > me_;
    if (!Rules::counts(state, peer_)) return effects;
    const Incarnation before = peer_;
    peer_ = Rules::followed(state, peer_);
    if (peer_ > before && mode_ == Sending::exchange && number_.any()) pending_ = true;
    if (pending_ && Rules::acknowledges(state, me_, number_)) {
      effects.taken = waiting_;
      waiting_ = pending_ = false;
    } else if (Rules::ends_repetition(state, me_, number_) && !waiting_) {
      pending_ = false;
    }
    if (pending_ && peer_ != before) effects.send = data();
    return effects;
  }

  /// Sends again what may be lost, when the time has come.
  [[nodiscard]] Effects repeat() const {
    if (pending_) return {.send = data()};
    // An unknown receiver has accepted nothing.
    if (recall_ && peer_.known()) return {.send = data()};
    return {};
  }

  [[nodiscard]] bool waiting() const { return waiting_; }
  /// Whether the newest value is still to be delivered, and not known to be taken.
  [[nodiscard]] bool pending() const { return pending_; }
  /// Whether the newest value was given up and is being recalled.
  [[nodiscard]] bool recalling() const { return recall_; }
  [[nodiscard]] bool repeats() const { return pending_ || recall_; }
  [[nodiscard]] Incarnation incarnation() const { return me_; }
  [[nodiscard]] Incarnation peer() const { return peer_; }
  [[nodiscard]] Number number() const { return number_; }

  auto operator<=>(const BasicSender&) const = default;

 private:
  [[nodiscard]] Data data() const { return {me_, Rules::target(peer_), number_, recall_}; }

  Sending mode_;
  bool waiting_ = false, recall_ = false;
  Incarnation me_, peer_;
  Number number_;

 protected:
  bool pending_ = false;
};
using Sender = BasicSender<>;

}  // namespace tessera::network
