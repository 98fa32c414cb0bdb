#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "tessera/ros2_nodes.hpp"

/// The life of a managed node, as rcl_lifecycle defines it.
namespace tessera::ros2 {

/// The numbers are those of lifecycle_msgs/msg/State.
enum class LifecycleState : std::uint8_t {
  unknown = 0,
  unconfigured = 1,
  inactive = 2,
  active = 3,
  finalized = 4,
  configuring = 10,
  cleaning_up = 11,
  shutting_down = 12,
  activating = 13,
  deactivating = 14,
  error_processing = 15
};
[[nodiscard]] const char* label_of(LifecycleState state);
/// All states, in the order of rcl_lifecycle.
[[nodiscard]] std::span<const LifecycleState> lifecycle_states();

/// The numbers are those of lifecycle_msgs/msg/Transition.
struct LifecycleTransition {
  std::uint8_t id = 0;
  const char* label = "";
  LifecycleState from = LifecycleState::unknown, to = LifecycleState::unknown;
};
/// All transitions, in the order of rcl_lifecycle.
[[nodiscard]] std::span<const LifecycleTransition> lifecycle_transitions();

/// The state of one node.
///
/// Threads: one at a time.
class Lifecycle {
 public:
  [[nodiscard]] LifecycleState state() const { return state_; }
  /// The transitions from the present state.
  [[nodiscard]] std::vector<LifecycleTransition> available() const;

  /// The order of a request. A label counts more than a number, as in rclcpp_lifecycle. nullopt: it does not fit the
  /// state, which stays.
  [[nodiscard]] std::optional<LifecycleOrder> request(std::uint8_t id, std::string_view label);
  /// false: it does not fit the state, which stays.
  [[nodiscard]] bool begin(LifecycleOrder order);
  /// Ends the order that was begun last. An error is processed, and leaves the node unconfigured. Without an order, it
  /// does nothing.
  void finish(LifecycleOutcome outcome);
  /// The run has failed without an order: the same as an error.
  void fail();

  /// The steps since the last call, the oldest first.
  [[nodiscard]] std::vector<LifecycleTransition> take_steps();

 private:
  void go(const LifecycleTransition& step);
  /// From the present state. false: there is none.
  bool go(std::uint8_t id);

  LifecycleState state_ = LifecycleState::unconfigured;
  std::uint8_t under_way_ = 0;  ///< the number of the order's transition on success; 0: there is no order
  std::vector<LifecycleTransition> steps_;
};

}  // namespace tessera::ros2
