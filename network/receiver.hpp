#pragma once

#include <optional>

#include "network/messages.hpp"

namespace tessera::network {

/// The decisions of a receiver about data. See SenderRules.
struct ReceiverRules {
  static bool is_for(const Data& data, Incarnation me) { return data.to == me; }
  /// A sender that writes to another incarnation of this receiver learns about this one.
  static bool answers_strangers() { return true; }
  static bool is_newer(Incarnation from, Incarnation peer) { return from > peer; }
  /// The numbers of a new incarnation of the sender begin again.
  static Number taken_of_new_sender(Number /*taken*/) { return {}; }
  static bool was_taken(Number number, Number taken) { return number <= taken; }
  /// The acknowledgement may have been lost.
  static bool answers_repetition() { return true; }
  static bool is_duplicate(Number number, Number in_slot) { return number <= in_slot; }
  /// An arrived value does not yet count as taken: the receiver may restart before it is read.
  static bool acknowledges_arrival() { return false; }
  static bool acknowledges_duplicates() { return false; }
  static bool announces_itself() { return true; }
};

enum class Receiving : std::uint8_t {
  once,     ///< each value is read once
  exchange  ///< non-blocking at both ends: the latest value may be read again and again
};

/// The receiver's side of a channel between processes. Its owner keeps a slot for one value. The owner
/// reports every message and the begin and end of each read, sends the states that this class asks for, and
/// calls repeat() from time to time while repeats() is true.
///
/// Threads: one at a time. No member allocates or throws.
template <class Rules = ReceiverRules>
class BasicReceiver {
 public:
  struct Effects {
    std::optional<State> answer{};
    bool keep = false;       ///< put the value of this message into the slot
    bool later = false;      ///< the slot is being read: give this message again afterwards
    bool malformed = false;  ///< no sender sends this message: it was dropped
  };

  BasicReceiver(Receiving mode, Incarnation me) : mode_(mode), me_(me) {}

  Effects hear(const Data& data) {
    if (!data.from.known() || !data.number.any()) return {.malformed = true};
    if (reading_) return {.later = true};
    if (!Rules::is_for(data, me_)) return data.recall || !Rules::answers_strangers() ? Effects{} : answer();
    const bool newer = Rules::is_newer(data.from, peer_);
    if (!newer && data.from < peer_) return {};
    if (newer) follow(data.from);
    if (data.recall) return take_back(data.number);
    if (Rules::was_taken(data.number, taken_)) return Rules::answers_repetition() ? answer() : Effects{};
    if (Rules::is_duplicate(data.number, slot_))
      return Rules::acknowledges_duplicates() ? answer_as_if_taken(data.number) : Effects{};
    slot_ = data.number;
    Effects effects;
    if (mode_ == Receiving::exchange) {
      taken_ = data.number;
      effects = answer();
    } else if (Rules::acknowledges_arrival()) {
      effects = answer_as_if_taken(data.number);
    }
    effects.keep = true;
    return effects;
  }

  /// The user begins to read the slot. Precondition: full(), not reading().
  void begin_read() { reading_ = true; }
  /// The value was taken. Precondition: reading().
  Effects end_read() {
    reading_ = false;
    if (mode_ == Receiving::exchange) return {};
    taken_ = slot_;
    slot_ = {};
    return answer();
  }

  /// Announces this receiver again when the time has come.
  [[nodiscard]] Effects repeat() const { return repeats() ? answer() : Effects{}; }
  /// Whether no sender has been heard since the start.
  [[nodiscard]] bool repeats() const { return Rules::announces_itself() && !peer_.known(); }

  [[nodiscard]] bool full() const { return slot_.any(); }
  [[nodiscard]] bool reading() const { return reading_; }
  [[nodiscard]] Incarnation incarnation() const { return me_; }
  [[nodiscard]] Incarnation peer() const { return peer_; }
  [[nodiscard]] Number slot() const { return slot_; }
  [[nodiscard]] Number taken() const { return taken_; }

  auto operator<=>(const BasicReceiver&) const = default;

 private:
  /// Follows a new incarnation of the sender: an unread value of the old one is discarded.
  void follow(Incarnation sender) {
    peer_ = sender;
    taken_ = Rules::taken_of_new_sender(taken_);
    slot_ = {};
  }

  /// Acts as if the value had been taken.
  Effects take_back(Number number) {
    if (number > taken_) {
      taken_ = number;
      if (slot_ <= number) slot_ = {};
    }
    return {};
  }

  [[nodiscard]] Effects answer() const { return {.answer = State{me_, peer_, taken_}}; }
  [[nodiscard]] Effects answer_as_if_taken(Number number) const {
    return {.answer = State{me_, peer_, number}};
  }

  Receiving mode_;
  bool reading_ = false;
  Incarnation me_, peer_;
  Number taken_, slot_;
};
using Receiver = BasicReceiver<>;

}  // namespace tessera::network
