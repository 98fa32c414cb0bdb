#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>
#include <type_traits>

#include "tessera/value_encoding.hpp"

namespace tessera {

/// Whether `value` is T{}; a zero with a minus is not.
template <class T>
[[nodiscard]] bool is_initial(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    return value == 0 && !std::signbit(value);
  } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    return value == T{};
  } else if constexpr (BoundedText<T>) {
    return value.view().empty();
  } else if constexpr (Sequence<T>) {
    if (encoding::extent<T>() == 0 && value.begin() != value.end()) return false;
    return std::all_of(value.begin(), value.end(), [](const auto& element) { return is_initial(element); });
  } else if constexpr (WithFields<T>) {
    return std::apply([&](auto... member) { return (is_initial(value.*member) && ...); },
                      tessera_fields_of(value));
  } else if constexpr (std::is_trivially_copyable_v<T>) {
    const T initial{};
    return std::memcmp(&value, &initial, sizeof(T)) == 0;
  } else {
    return false;
  }
}

/// Whether a T has floating-point numbers that are stored in place. In these, a write of zero can be seen.
template <class T>
[[nodiscard]] constexpr bool can_be_marked() {
  if constexpr (std::is_floating_point_v<T>) {
    return true;
  } else if constexpr (!std::is_trivially_copyable_v<T> && !WithFields<T>) {
    return false;
  } else if constexpr (Sequence<T>) {
    return can_be_marked<encoding::Element<T>>();
  } else if constexpr (WithFields<T>) {
    return encoding::with_field_types<T>(
        [](auto... member) { return (can_be_marked<typename decltype(member)::type>() || ...); });
  } else {
    return false;
  }
}

/// Gives each floating-point zero of `value` a minus.
template <class T>
void mark_zeros(T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (value == 0) value = -T{0};
  } else if constexpr (!can_be_marked<T>()) {
    return;
  } else if constexpr (Sequence<T>) {
    for (auto& element : value) mark_zeros(element);
  } else {
    std::apply([&](auto... member) { (mark_zeros(value.*member), ...); }, tessera_fields_of(value));
  }
}

/// Takes the minus away from each zero of `value`. Returns whether some floating-point number was not a zero
/// with a minus: it was written after mark_zeros.
template <class T>
bool unmark_zeros(T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (value != 0 || !std::signbit(value)) return true;
    value = T{0};
    return false;
  } else if constexpr (!can_be_marked<T>()) {
    return false;
  } else if constexpr (Sequence<T>) {
    bool written = false;
    for (auto& element : value) written = unmark_zeros(element) || written;
    return written;
  } else {
    return std::apply([&](auto... member) { return (int{unmark_zeros(value.*member)} | ...); },
                      tessera_fields_of(value)) != 0;
  }
}

/// How the runtime notices that a transition function has written an output, although its value is still the
/// initial one. A number, a bool, and a structure that is assigned as a whole set Departure::tessera_assigned.
/// In a structure whose fields are assigned, the runtime gives each floating-point zero a minus before the
/// call. A zero that has no minus afterwards was written. Writes to other fields leave no trace.
struct WriteTrace {
  bool (*initial)(const void* value);  ///< is_initial
  void (*reset)(void* value);          ///< makes it initial
  void (*mark)(void* value);           ///< mark_zeros; nullptr: it has no such numbers
  bool (*unmark)(void* value);         ///< unmark_zeros; nullptr: it has no such numbers
  bool hides;                          ///< a write to some field leaves no trace
};

/// Whether a write to some field of a T leaves no trace.
template <class T>
[[nodiscard]] constexpr bool hides_writes() {
  if constexpr (std::is_floating_point_v<T>) {
    return false;
  } else if constexpr (Sequence<T> && std::is_trivially_copyable_v<T>) {
    return hides_writes<encoding::Element<T>>();
  } else if constexpr (WithFields<T>) {
    return encoding::with_field_types<T>(
        [](auto... member) { return (hides_writes<typename decltype(member)::type>() || ...); });
  } else {
    return true;
  }
}

template <class T>
[[nodiscard]] const WriteTrace* write_trace_of() {
  static constexpr WriteTrace trace = [] {
    WriteTrace made{[](const void* value) { return is_initial(*static_cast<const T*>(value)); },
                    [](void* value) { *static_cast<T*>(value) = T{}; }, nullptr, nullptr,
                    std::is_class_v<T> && hides_writes<T>()};
    if constexpr (std::is_class_v<T> && can_be_marked<T>()) {
      made.mark = [](void* value) { mark_zeros(*static_cast<T*>(value)); };
      made.unmark = [](void* value) { return unmark_zeros(*static_cast<T*>(value)); };
    }
    return made;
  }();
  return &trace;
}

}  // namespace tessera
