#pragma once

#include <cstdint>
#include <type_traits>

#include "tessera/time.hpp"

namespace tessera {

/// The status of the value in an input buffer.
///
/// A value is valid if its producer has written it and did not fail. An invalid value that comes changes only
/// `valid` and `failed`: the buffer keeps the last valid value, with its stamp and age.
struct Arrival {
  bool fresh = false;              ///< a valid value has come since the last iteration
  bool timed_out = false;          ///< the last receive gave up waiting
  bool valid = false;              ///< the last value that came is valid
  Time stamp{};                    ///< when the producer wrote the last valid value
  Duration age = Duration::max();  ///< now - stamp; Duration::max() before the first valid value
  bool disconnected = false;       ///< the producer is in another process, which is not reachable
  bool failed = false;  ///< the last value that came is invalid: its producer failed or did not write it
};

/// The status of the value in an output buffer.
struct Departure {
  bool timed_out = false;         ///< the last blocking send gave up waiting for its acknowledgement
  Time stamp{};                   ///< when it was last written to the channel
  bool disconnected = false;      ///< the consumer is in another process, which is not reachable
  bool tessera_assigned = false;  ///< assigned as a whole since the runtime reset this flag
};

/// The status of an output that some behaviour may skip: `skip: allowed` in the specification.
struct SkippableDeparture : Departure {
  bool tessera_skipped = false;  ///< by the transition function in this iteration
  /// Sends nothing in this iteration, over any channel of the output. Its value stays; a receiver that blocks
  /// waits. In a behaviour whose `send` does not allow it, this is a fault. No effect if the iteration fails.
  void skip() { tessera_skipped = true; }
};

/// Notes that an output was written.
template <class Status>
void note_assignment(Status& status) {
  if constexpr (requires { status.tessera_assigned; }) status.tessera_assigned = true;
}
/// The status after an assignment of a whole buffer. Between outputs only the value is copied; between inputs
/// the status is copied too.
template <class Status>
void assign_status(Status& status, const Status& other) {
  if constexpr (requires { status.tessera_assigned; })
    status.tessera_assigned = true;
  else
    status = other;
}

/// A value with its status. If the value is a structure, its fields and the status are members side by side
/// (`in.line.left`, `in.line.fresh`); the names of the status are reserved in specifications.
template <class T, class Status, bool = std::is_class_v<T>>
struct Buffer : T, Status {
  Buffer() : T{}, Status{} {}
  // NOLINTNEXTLINE(google-explicit-constructor): a value is a buffer of it
  Buffer(const T& value) : T(value), Status{} {}
  Buffer(const Buffer&) = default;
  Buffer& operator=(const T& value) {
    static_cast<T&>(*this) = value;
    note_assignment<Status>(*this);
    return *this;
  }
  Buffer& operator=(const Buffer& other) {
    static_cast<T&>(*this) = other;
    assign_status<Status>(*this, other);
    return *this;
  }
  friend T& payload(Buffer& buffer) { return buffer; }
};

/// The same for a number or a bool, to which the buffer converts.
template <class T, class Status>
struct Buffer<T, Status, false> : Status {
  Buffer() = default;
  Buffer(T value) : value_(value) {}  // NOLINT(google-explicit-constructor)
  Buffer(const Buffer&) = default;
  Buffer& operator=(T value) {
    value_ = value;
    note_assignment<Status>(*this);
    return *this;
  }
  Buffer& operator=(const Buffer& other) {
    value_ = other.value_;
    assign_status<Status>(*this, other);
    return *this;
  }
  Buffer& operator+=(T value) { return *this = static_cast<T>(value_ + value); }
  Buffer& operator-=(T value) { return *this = static_cast<T>(value_ - value); }
  Buffer& operator*=(T value) { return *this = static_cast<T>(value_ * value); }
  Buffer& operator/=(T value) { return *this = static_cast<T>(value_ / value); }
  operator const T&() const { return value_; }  // NOLINT(google-explicit-constructor)
  [[nodiscard]] const T& value() const { return value_; }
  friend T& payload(Buffer& buffer) { return buffer.value_; }

 private:
  T value_{};
};

template <class T>
using Input = Buffer<T, Arrival>;
template <class T>
using Output = Buffer<T, Departure>;
template <class T>
using SkippableOutput = Buffer<T, SkippableDeparture>;

/// Questions about the buffers of which there is one for each member of a fleet (`request: "Request[each robot]"`).
/// holds: a function of one of them: `tessera::which(in.request, [](const auto& one) { return one.fresh; })`.
template <class Buffers, class Holds>
[[nodiscard]] constexpr std::uint32_t count(const Buffers& buffers, Holds holds) {
  std::uint32_t number = 0;
  for (const auto& one : buffers) number += holds(one) ? 1U : 0U;
  return number;
}
/// The number of the first member for which it holds; without one the number of members.
template <class Buffers, class Holds>
[[nodiscard]] constexpr std::uint32_t which(const Buffers& buffers, Holds holds) {
  std::uint32_t member = 0;
  for (const auto& one : buffers) {
    if (holds(one)) return member;
    ++member;
  }
  return member;
}
template <class Buffers, class Holds>
[[nodiscard]] constexpr bool any(const Buffers& buffers, Holds holds) {
  return which(buffers, holds) < buffers.size();
}
template <class Buffers, class Holds>
[[nodiscard]] constexpr bool all(const Buffers& buffers, Holds holds) {
  return count(buffers, holds) == buffers.size();
}

}  // namespace tessera
