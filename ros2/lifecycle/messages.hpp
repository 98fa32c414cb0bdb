#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ros2/lifecycle/lifecycle.hpp"

/// The messages of lifecycle_msgs, with encapsulation and without the header of a request.
namespace tessera::ros2 {

/// The request of ChangeState.
struct ChangeRequest {
  std::uint8_t id = 0;
  std::string label{};  ///< empty: the number counts
};
/// Takes any bytes; nullopt: they are no such request.
[[nodiscard]] std::optional<ChangeRequest> read_change_request(std::span<const std::byte> message);

[[nodiscard]] std::vector<std::byte> change_answer(bool success);
[[nodiscard]] std::vector<std::byte> state_answer(LifecycleState state);
[[nodiscard]] std::vector<std::byte> states_answer(std::span<const LifecycleState> states);
[[nodiscard]] std::vector<std::byte> transitions_answer(std::span<const LifecycleTransition> transitions);
/// lifecycle_msgs/msg/TransitionEvent. time_ns: since 1970.
[[nodiscard]] std::vector<std::byte> transition_event(std::uint64_t time_ns, const LifecycleTransition& step);

}  // namespace tessera::ros2
