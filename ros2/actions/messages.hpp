#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ros2/actions/goal.hpp"
#include "ros2/codec/translator.hpp"
#include "ros2/definitions/type.hpp"

/// The messages of an action's services and topics, with encapsulation and without the header of a request.
/// Whatever reads them takes any bytes; nullopt: they are no such message.
namespace tessera::ros2 {

using MessageBytes = std::vector<std::byte>;

/// A goal or feedback, which has the name of the goal before its data.
[[nodiscard]] MessageBytes with_goal_id(const GoalId& id, std::span<const std::byte> message);
struct NamedMessage {
  GoalId id{};
  MessageBytes message{};  ///< without the name
};
[[nodiscard]] std::optional<NamedMessage> split_goal_id(std::span<const std::byte> message);

/// ..._SendGoal_Response
[[nodiscard]] MessageBytes goal_answer(bool accepted, const Stamp& at);
[[nodiscard]] std::optional<bool> read_goal_answer(std::span<const std::byte> message);

/// ..._GetResult_Request
[[nodiscard]] MessageBytes result_request(const GoalId& id);
[[nodiscard]] std::optional<GoalId> read_result_request(std::span<const std::byte> message);
/// The state in a ..._GetResult_Response.
[[nodiscard]] std::optional<std::int8_t> read_result_status(std::span<const std::byte> message);

/// action_msgs/srv/CancelGoal
struct CancelRequest {
  GoalId id{};  ///< zeros: any goal
  Stamp stamp{};
};
[[nodiscard]] MessageBytes cancel_request(const CancelRequest& request);
[[nodiscard]] std::optional<CancelRequest> read_cancel_request(std::span<const std::byte> message);
struct GoalInfo {
  GoalId id{};
  Stamp stamp{};
};
[[nodiscard]] MessageBytes cancel_answer(CancelCode code, std::span<const GoalInfo> canceling);
[[nodiscard]] std::optional<CancelCode> read_cancel_answer(std::span<const std::byte> message);

/// action_msgs/msg/GoalStatusArray
struct GoalStatus {
  GoalInfo info{};
  std::int8_t status = 0;
};
[[nodiscard]] MessageBytes status_message(std::span<const GoalStatus> goals);
[[nodiscard]] std::optional<std::vector<GoalStatus>> read_status(std::span<const std::byte> message);

/// The two messages behind a buffer that has feedback and result (ResolvedAction::progress).
class ProgressType {
 public:
  /// progress: with its fields `feedback` and `result`.
  explicit ProgressType(std::shared_ptr<const Structure> progress) : progress_(std::move(progress)) {}

  /// One message of both. feedback: without the name of the goal. result: with its state. Empty ones are zeros.
  [[nodiscard]] std::optional<MessageBytes> join(std::span<const std::byte> feedback,
                                                 std::span<const std::byte> result) const;
  struct Parts {
    MessageBytes feedback{};  ///< without the name of the goal
    MessageBytes result{};    ///< with a state
  };
  /// status: of the result.
  [[nodiscard]] std::optional<Parts> split(std::span<const std::byte> progress, std::int8_t status) const;
  /// A result of zeros.
  [[nodiscard]] MessageBytes empty_result(std::int8_t status) const;

 private:
  [[nodiscard]] const Structure& part(std::size_t index) const {
    return *progress_->fields[index].type.structure;
  }
  std::shared_ptr<const Structure> progress_;
};

}  // namespace tessera::ros2
