#pragma once

#include <compare>
#include <cstdint>

/// The protocol of channels between processes: the messages that the two sides of a channel exchange, and how
/// each side reacts to them. It knows no middleware, no clock and no values (docs/use/fleets.md).
namespace tessera::network {

/// The number of a start of a process, greater than those of all earlier starts. 0: none, or not known.
struct Incarnation {
  std::uint64_t value = 0;
  auto operator<=>(const Incarnation&) const = default;
  [[nodiscard]] bool known() const { return value != 0; }
};

/// The number of a value of a channel. Each incarnation of its sender counts from 1. 0: no value.
struct Number {
  std::uint64_t value = 0;
  auto operator<=>(const Number&) const = default;
  [[nodiscard]] bool any() const { return value != 0; }
};

/// From the sender: a value, or its recall. The bytes of the value travel beside it.
struct Data {
  Incarnation from;
  Incarnation to;  ///< of the receiver, if the sender knows it
  Number number;
  bool recall = false;
  auto operator<=>(const Data&) const = default;
};

/// From the receiver: its state. It is never an event, so a message may be lost, repeated or overtaken.
struct State {
  Incarnation from;
  Incarnation peer;  ///< of the sender that it follows
  Number taken;      ///< the last value of that sender that was taken or recalled
  auto operator<=>(const State&) const = default;
};

}  // namespace tessera::network
