#pragma once

#include <compare>
#include <cstdint>

/// The protocol of channels between processes: what two sides of a channel tell each other, and what each
/// makes of it. It knows no middleware, no clock and no values (docs/fleets.md).
namespace tessera::network {

/// The number of a start of a process, greater than those of all earlier starts. 0: none, or not known.
struct Incarnation {
  std::uint64_t value = 0;
  auto operator<=>(const Incarnation&) const = default;
  [[nodiscard]] bool known() const { return value != 0; }
};

/// The number of a value of a channel, from 1 in every incarnation of its sender. 0: no value.
struct Number {
  std::uint64_t value = 0;
  auto operator<=>(const Number&) const = default;
  [[nodiscard]] bool any() const { return value != 0; }
};

/// From the sender: a value, or that it is called back. The value itself travels beside it.
struct Data {
  Incarnation from;
  Incarnation to;  ///< of the receiver, as far as it is known
  Number number;
  bool recall = false;
  auto operator<=>(const Data&) const = default;
};

/// From the receiver: its state. It is never an event, so that a message may be lost, repeated and overtaken.
struct State {
  Incarnation from;
  Incarnation peer;  ///< of the sender that it follows
  Number taken;      ///< the last value of that sender that was taken, or called back
  auto operator<=>(const State&) const = default;
};

}  // namespace tessera::network
