#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

/// Numbers of the elements of a system, one type for each kind of element, and lists that know the kind of
/// their numbers. Specification, nets and runtime use them.
namespace tessera {

/// The number of an element, counted from 0. Numbers of different kinds do not mix. A default one is none.
template <class Tag>
struct Id {
  std::uint32_t value = UINT32_MAX;
  auto operator<=>(const Id&) const = default;
  [[nodiscard]] constexpr bool valid() const { return value != UINT32_MAX; }
};

// Specification, net and recordings number these alike.
using AgentId = Id<struct AgentTag>;
using InstanceId = Id<struct InstanceTag>;    ///< a subsystem of an agent
using BehaviourId = Id<struct BehaviourTag>;  ///< of one subsystem
using ChannelId = Id<struct ChannelTag>;
using ProcessId = Id<struct ProcessTag>;  ///< of a deployment

/// The numbers 0 to count - 1 of one kind, for loops.
template <class Id>
class Ids {
 public:
  struct Iterator {
    Id id;
    Id operator*() const { return id; }
    Iterator& operator++() {
      ++id.value;
      return *this;
    }
    bool operator==(const Iterator&) const = default;
  };
  explicit Ids(std::size_t count) : end_{{static_cast<std::uint32_t>(count)}} {}
  [[nodiscard]] Iterator begin() const { return {{0}}; }
  [[nodiscard]] Iterator end() const { return end_; }

 private:
  Iterator end_;
};

/// A vector whose elements have numbers of one kind. A number of another kind is no index of it.
template <class Id, class T>
class Numbered : public std::vector<T> {
  using Base = std::vector<T>;

 public:
  using Base::Base;
  Numbered() = default;
  // Implicit: the elements get their numbers here.
  Numbered(Base elements) : Base(std::move(elements)) {}  // NOLINT(google-explicit-constructor)

  using Base::operator[];
  typename Base::reference operator[](Id id) { return (*this)[id.value]; }
  typename Base::const_reference operator[](Id id) const { return (*this)[id.value]; }

  /// All numbers, in order.
  [[nodiscard]] Ids<Id> ids() const { return Ids<Id>(Base::size()); }
  [[nodiscard]] bool has(Id id) const { return id.value < Base::size(); }
  /// The number that the next element will have.
  [[nodiscard]] Id next_id() const { return {static_cast<std::uint32_t>(Base::size())}; }
};

}  // namespace tessera
