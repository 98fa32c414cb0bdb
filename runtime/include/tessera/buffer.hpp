#pragma once

#include <type_traits>

#include "tessera/time.hpp"

namespace tessera {

/// The status of the value in an input buffer.
struct Arrival {
  bool fresh = false;              ///< new since the last iteration
  bool timed_out = false;          ///< the last receive gave up waiting
  bool valid = false;              ///< the producer has written it, and its transition function did not fail
  Time stamp{};                    ///< when the producer wrote it
  Duration age = Duration::max();  ///< now - stamp; Duration::max() before the first value
  bool disconnected = false;       ///< the producer is in another process, which is not reachable
};

/// The status of the value in an output buffer.
struct Departure {
  bool timed_out = false;     ///< the last blocking send gave up waiting for its acknowledgement
  Time stamp{};               ///< when it was last written to the channel
  bool disconnected = false;  ///< the consumer is in another process, which is not reachable
};

/// A value with its status. If the value is a structure, its fields and the status are members side by side
/// (`in.line.left`, `in.line.fresh`); the names of the status are reserved in specifications.
template <class T, class Status, bool = std::is_class_v<T>>
struct Buffer : T, Status {
  Buffer() : T{}, Status{} {}
  // NOLINTNEXTLINE(google-explicit-constructor): a value is a buffer of it
  Buffer(const T& value) : T(value), Status{} {}
  Buffer& operator=(const T& value) {
    static_cast<T&>(*this) = value;
    return *this;
  }
  friend T& payload(Buffer& buffer) { return buffer; }
};

/// The same for a number or a bool, to which the buffer converts.
template <class T, class Status>
struct Buffer<T, Status, false> : Status {
  Buffer() = default;
  Buffer(T value) : value_(value) {}  // NOLINT(google-explicit-constructor)
  Buffer& operator=(T value) {
    value_ = value;
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

}  // namespace tessera
