#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "network/dds/deployment.hpp"

namespace tessera::dds {

/// The fields of a message as the middleware gives them. Any host on the network can have written them.
struct ReceivedData {
  std::uint32_t channel = 0, process = 0;
  std::uint64_t from = 0, to = 0, number = 0;
  std::int64_t stamp_ns = 0;
  bool recall = false, valid = false;
  std::span<const std::byte> bytes;
};
struct ReceivedState {
  std::uint32_t channel = 0, process = 0;
  std::uint64_t from = 0, peer = 0, taken = 0;
};
struct ReceivedAlive {
  std::uint32_t process = 0;
  std::uint64_t incarnation = 0;
  std::uint64_t number = 0;
  std::int64_t sent_ns = 0, wall_ns = 0;
  std::uint32_t echo_process = 0;
  std::uint64_t echo_incarnation = 0;
  std::int64_t echo_ns = 0, held_ns = 0;
};

/// The reason why a message is dropped. No process of the deployment sends such a message.
enum class Refusal : std::uint8_t {
  none,
  unknown_channel,   ///< or the channel does not begin or end in this process
  wrong_process,     ///< the channel does not begin (end) in the process that it names
  wrong_direction,   ///< this process sends on that channel (receives from it)
  no_incarnation,    ///< the sender names no incarnation
  no_number,         ///< the value has no number
  state_of_nothing,  ///< a state that acknowledges a value of no sender
  recall_with_value,
  too_large,
  time_before_zero,
  no_peer  ///< no channel joins that process and this one
};

[[nodiscard]] Refusal check(const ReceivedData& data, const Deployment& deployment);
[[nodiscard]] Refusal check(const ReceivedState& state, const Deployment& deployment);
[[nodiscard]] Refusal check(const ReceivedAlive& alive, const Deployment& deployment);

/// "data of channel a.x->b.y from process 7: the channel does not begin or end there"
[[nodiscard]] std::string description(Refusal refusal, const ReceivedData& data,
                                      const Deployment& deployment);
[[nodiscard]] std::string description(Refusal refusal, const ReceivedState& state,
                                      const Deployment& deployment);
[[nodiscard]] std::string description(Refusal refusal, const ReceivedAlive& alive,
                                      const Deployment& deployment);

}  // namespace tessera::dds
