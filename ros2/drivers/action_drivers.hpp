#pragma once

#include <memory>
#include <string>

#include "tessera/ros2.hpp"

namespace tessera::ros2 {

/// One side of an action, as docs/use/ros2.md describes it. The receptor and the effector of an agent with the
/// same action and role work together. nullptr and `error`: the binding is wrong.
///
/// Client: the effector orders a goal when the field `call` has a new number that is not 0, and cancels it. The
/// receptor gives what becomes of it.
/// Server: the receptor gives each goal once, and again when it is to be cancelled. The effector says what
/// becomes of the goal whose number is in `call`.
[[nodiscard]] std::unique_ptr<RealReceptor> make_action_receptor(const Ros2Binding& binding,
                                                                 std::string& error);
[[nodiscard]] std::unique_ptr<RealEffector> make_action_effector(const Ros2Binding& binding,
                                                                 std::string& error);

}  // namespace tessera::ros2
