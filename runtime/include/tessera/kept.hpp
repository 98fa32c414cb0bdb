#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "tessera/goal_life.hpp"

namespace tessera {

struct Bindings;

/// A member of a fleet, by its number, as a value of memory (`values: [nobody, each robot]`).
struct Member {
  std::uint32_t number = 0;
};
/// The fleet in conditions: `memory.lent_to == robot[i]`.
struct Members {
  constexpr Member operator[](std::uint32_t number) const { return {number}; }
};
/// The positions of the values that are members.
struct MemberValues {
  std::uint32_t first = 0, count = 0;
};

/// A value of memory that is part of the net (`values` in the specification). The net changes it, with its
/// firings: transition functions and conditions read it as the enumeration.
///
/// Value: an enumeration that counts from 0. `tessera_names_of(Value)` gives the names of its enumerators.
template <class Value>
class Kept {
 public:
  Kept() = default;
  explicit constexpr Kept(Value initial) : value_(initial) {}
  Kept(const Kept&) = default;
  Kept& operator=(const Kept&) = delete;
  Kept(Kept&&) = default;
  Kept& operator=(Kept&&) = delete;
  ~Kept() = default;

  constexpr operator Value() const { return value_; }  // NOLINT(google-explicit-constructor)
  friend constexpr bool operator==(const Kept& kept, Value value) { return kept.value_ == value; }

  friend constexpr bool operator==(const Kept& kept, Member member) { return kept.member() == member.number; }
  /// The number of the member of the fleet that the value is; nullopt: another value.
  [[nodiscard]] constexpr std::optional<std::uint32_t> member() const {
    if constexpr (requires { tessera_members_of(Value{}); }) {
      constexpr MemberValues members = tessera_members_of(Value{});
      const auto number = static_cast<std::uint32_t>(value_) - members.first;
      if (static_cast<std::uint32_t>(value_) >= members.first && number < members.count) return number;
    }
    return std::nullopt;
  }

  /// The name of the value. Recordings keep it as a text.
  [[nodiscard]] std::string_view view() const {
    return tessera_names_of(Value{})[static_cast<std::size_t>(value_)];
  }
  [[nodiscard]] static constexpr std::size_t capacity() {
    std::size_t longest = 0;
    for (const std::string_view name : tessera_names_of(Value{}))
      if (name.size() > longest) longest = name.size();
    return longest;
  }

 private:
  friend struct Bindings;
  void set(std::uint32_t position) { value_ = static_cast<Value>(position); }
  Value value_{};
};

/// A counter of memory that is part of the net (`counts` in the specification), from Least to Most. The net changes
/// it, with its firings: transition functions and conditions read it as a number.
template <int Least, int Most>
class Counter {
 public:
  Counter() = default;
  explicit constexpr Counter(int initial) : value_(initial) {}
  Counter(const Counter&) = default;
  Counter& operator=(const Counter&) = delete;
  Counter(Counter&&) = default;
  Counter& operator=(Counter&&) = delete;
  ~Counter() = default;

  constexpr operator int() const { return value_; }  // NOLINT(google-explicit-constructor)

  static constexpr int least = Least, most = Most;

 private:
  friend struct Bindings;
  void set(std::uint32_t position) { value_ = Least + static_cast<int>(position); }
  int value_ = Least;
};

/// A name that several enumerations have, in conditions: it is compared with any of them.
template <auto Value>
struct NamedValue {
  constexpr operator decltype(Value)() const { return Value; }  // NOLINT(google-explicit-constructor)
};
template <auto... Values>
struct NamedValues : NamedValue<Values>... {};

}  // namespace tessera
