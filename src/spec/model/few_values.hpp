#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/ids.hpp"

namespace tessera::spec {

/// The buffers of a goal whose life a memory cell holds: `{ goal: out.goal, progress: in.progress }`.
struct GoalBuffers {
  BufferId goal{};       ///< the output that orders it, with the fields `call` and perhaps `cancel`
  BufferId progress{};   ///< the input that tells of it, with the fields `call` and `state`
  bool cancels = false;  ///< the output has the field `cancel`
};

/// The values of a memory cell that is part of the net: `{ values: [nobody, a, b] }`, `{ counts: 0..4 }`, or the states
/// of a goal.
struct FewValues {
  std::vector<std::string> names;        ///< of a counter "0", "1" ...
  std::vector<diagnostics::Span> spans;  ///< as names; of a counter empty
  bool counts = false;
  std::uint32_t least = 0;    ///< of a counter
  std::uint32_t initial = 0;  ///< at the start; into names. Without `initial` the first, or the lowest count
  /// With `each robot` among the values: the fleet, and the position of the value of its first member. The values of
  /// the others follow, "robot[0]", "robot[1]" ...
  std::string fleet{};
  std::uint32_t first_member = 0, member_count = 0;
  /// The buffers of a goal. Its values are those of tessera::GoalState, in their order.
  std::optional<GoalBuffers> goal{};

  static constexpr std::size_t most = 256;  ///< values of one cell

  /// The position of a value among `names`.
  [[nodiscard]] std::optional<std::uint32_t> find(std::string_view name) const;
  /// "one of nobody, a, b", "a count from 0 to 4"; at most ten names.
  [[nodiscard]] std::string in_words() const;
};

/// A change of a cell with few values by a behaviour that begins, or by an entry of `next` that is taken.
struct Change {
  std::uint32_t cell = 0;   ///< into Subsystem::memory
  std::int32_t step = 0;    ///< +1 or -1; 0: the cell gets `value`
  std::uint32_t value = 0;  ///< into FewValues::names
  diagnostics::Span span{};

  /// The value after the change; nullopt: a counter would leave its range.
  [[nodiscard]] std::optional<std::uint32_t> after(std::uint32_t before, const FewValues& values) const;
};

/// A behaviour begins with a new goal: `orders: going`, `cancel: on_leave`.
struct Order {
  std::uint32_t cell = 0;        ///< into Subsystem::memory
  bool cancel_on_leave = false;  ///< a goal that has not ended is cancelled when the behaviour is left
  diagnostics::Span span{};

  /// The change of the cell.
  [[nodiscard]] Change change() const;
  /// Wherever it stands in the file.
  bool operator==(const Order& other) const {
    return cell == other.cell && cancel_on_leave == other.cancel_on_leave;
  }
};

/// The values of a cell from which changes in this order lead somewhere: its positions `first` to `last`. Steps
/// move by one, so these are neighbours. nullopt: none.
struct Allowed {
  std::uint32_t first, last;
};
[[nodiscard]] std::optional<Allowed> allowed(const FewValues& values, std::uint32_t cell,
                                             const std::vector<Change>& changes);

/// The enumeration of a cell with values in C++: "LentTo" of "lent_to".
///
/// taken: the names that it may not equal: structures, memory cells, the enumerations of cells before it.
[[nodiscard]] std::string enumeration_name(std::string_view cell, const std::set<std::string>& taken);

}  // namespace tessera::spec
