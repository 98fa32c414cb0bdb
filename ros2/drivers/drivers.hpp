#pragma once

#include <memory>
#include <string>

#include "tessera/ros2.hpp"

namespace tessera::ros2 {

/// A receptor that gives the newest message of a topic, once per message. A message that is malformed, or
/// does not fit the buffer, is dropped; a warning on standard error reports the 1st, 10th, 100th ... of them.
/// nullptr and `error`: the binding is wrong.
[[nodiscard]] std::unique_ptr<RealReceptor> make_receptor(const Ros2Binding& binding, std::string& error);

/// An effector that publishes each command. `close` waits up to half a second until all subscribers have
/// received the last one. In the guardian process, a command counts as taken when a subscriber has received
/// it.
[[nodiscard]] std::unique_ptr<RealEffector> make_effector(const Ros2Binding& binding, std::string& error);

}  // namespace tessera::ros2
