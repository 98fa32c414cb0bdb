#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "explore/budget.hpp"
#include "explore/formula.hpp"

namespace tessera::verify {

/// A part of a net with a question to it (partial_net.hpp), as numbers alone. Nothing else decides the answer, so parts
/// that are equal have the same one: those of the members of a fleet.
struct NumberedPart {
  using Numbers = std::vector<std::uint32_t>;
  struct Step {
    Numbers in{}, out{};     ///< places of the part, sorted
    Numbers needs{};         ///< places outside
    bool is_certain = true;  ///< it takes no place that counts as one with others
    bool is_alone = false;   ///< needs nothing, and nothing else takes its tokens: it can always be fired
    bool is_goal = false;    ///< a marking in which it can be fired is a goal
  };
  /// One of the places of a set, which always hold one token together.
  struct Member {
    bool is_outside = false;
    std::uint32_t place = 0;
    Numbers
        next{};  ///< is_outside: the members outside to which this token can pass alone, as indices into the set
  };
  using Set = std::vector<Member>;

  enum class Question : std::uint8_t {
    never,      ///< no marking that is reached makes `from` true
    can_reach,  ///< from markings in which `from` is true the goal is reached for certain
    reaches     ///< from these and from all that follow before the goal
  } question = Question::never;
  explore::Formula from, goal;  ///< over places of the part; constants for places that never change
  std::uint32_t places = 0;
  Numbers initial{};  ///< sorted
  std::vector<Step> steps{};
  std::vector<Set> sets{};
  std::vector<Numbers> sets_of{};  ///< per place outside

  /// All of it in one row: equal for parts that are equal, and only for these.
  [[nodiscard]] std::u32string written() const;

  struct Result {
    bool holds = false;
    Numbers helpful{};  ///< else: places outside whose users might help; sorted
    std::uint64_t markings = 0;
  };
  /// Throws explore::CutOff.
  [[nodiscard]] Result searched(const explore::Budget& budget) const;
};

}  // namespace tessera::verify
