#pragma once

#include <cstdint>
#include <vector>

#include "subsystem/reports.hpp"
#include "subsystem/subsystem_parts.hpp"
#include "tessera/goal_life.hpp"

namespace tessera {

/// The goals that one subsystem orders: their numbers, their cancels, and what their progress tells of them.
///
/// *Dropped.* A value of a goal that is no longer the ordered one says nothing. A value of a goal that was never
/// ordered, or of a state that the life of a goal does not allow after the one before, is a mistake of the receptor or of
/// who serves the goal: it is counted, and a warning says so at the 1st, 10th, 100th ... time. Neither changes memory.
///
/// *Withdrawn.* An order that has not gone out as valid when its behaviour is left, because the function failed or the
/// output was skipped, never goes out: `call` is 0 then, which orders nothing. The next receive tells that it is gone.
///
/// Threads: the subsystem's. Allocates nothing after construction.
class Goals {
 public:
  /// parts and reports must outlive it.
  Goals(const SubsystemParts& parts, const Reports& reports);

  [[nodiscard]] bool empty() const { return goals_.empty(); }
  /// A behaviour begins: the one before was left. It may order a goal, and what was left may have one to cancel.
  void begin(std::uint16_t behaviour);
  /// An output, by its value, was sent as valid.
  void note_sent(const void* output);
  /// Writes the numbers and cancels into the outputs, where the user's code may have changed them.
  void write() const;
  /// The net has given that value to a fact.
  void learn(std::uint16_t fact, std::uint16_t value);
  /// The state that memory has after a read over that port. taken: it took a new and valid value.
  [[nodiscard]] std::uint16_t told(std::uint32_t port, bool taken);
  /// Values that were dropped because of a mistake.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct Goal {
    const BoundGoal* bound = nullptr;
    std::uint32_t fact = 0;  // of the net
    GoalState state = GoalState::none;
    std::uint32_t call = 0;  // the number of the goal ordered last; 0: none was
    bool cancel = false;     // it shall be cancelled
    bool on_leave = false;   // it will be when the behaviour that has ordered it is left
    bool sent = false;       // its order has gone out as valid
    bool withdrawn = false;  // it had not when the behaviour was left: nobody is to work for it
    std::uint64_t dropped = 0;
  };
  void drop(Goal& goal, const BoundGoal::Progress& progress);

  const Reports& reports_;
  std::vector<Goal> goals_;
  std::vector<std::uint32_t> goal_of_port_;  // past the end: of none
  std::uint64_t dropped_ = 0;
};

}  // namespace tessera
