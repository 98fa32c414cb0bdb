#pragma once

#include <optional>
#include <vector>

#include "spec/document/section.hpp"
#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

/// Memory cells that hold the life of a goal, and the behaviours that order one.
namespace tessera::spec {

/// The buffers of a subsystem that goals may use.
struct GoalScope {
  const Numbered<BufferId, Field>&inputs, &outputs;
  const Types& types;
};

/// `{ goal: out.goal, progress: in.progress }`. Precondition: the section has one of these keys.
///
/// Errors: E101 unknown buffers; E103 a missing key; E362 a key or a path that does not belong there; E363 a buffer
///         without the fields that the life of a goal needs.
/// Returns the states in any case, so that no second error follows from the first.
[[nodiscard]] FewValues read_goal(const Section& cell, const GoalScope& buffers, Diagnostics& out);

/// `orders: going` and `cancel: on_leave` of a behaviour.
///
/// Errors: E101 unknown memory; E365 it is no goal; E366 `cancel` without `orders`, of a goal without that field, or
///         another word than on_leave.
[[nodiscard]] std::optional<Order> read_order(const Entry& behaviour, const std::vector<Field>& memory,
                                              Diagnostics& out);

/// Checks that orders are sent and their progress is received.
///
/// Errors: E364 two goals with one buffer; E368 a behaviour orders a goal and does not send it, E369 nor receives its
///         progress. Warnings: W395 a behaviour that ends by the state of a goal does not receive it; W396 a behaviour
///         that follows one with `cancel` does not send the goal; W397 no behaviour orders a goal.
void check_goals(const Subsystem& subsystem, Diagnostics& out);

}  // namespace tessera::spec
