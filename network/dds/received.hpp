#pragma once

#include <cstdint>
#include <string>

#include "network/dds/deployment.hpp"
#include "wire.h"

/// Judges messages as the middleware gives them. Any host on the network can have written them.
namespace tessera::dds {

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

[[nodiscard]] Refusal check(const tessera_wire_Data& data, const Deployment& deployment);
[[nodiscard]] Refusal check(const tessera_wire_State& state, const Deployment& deployment);
[[nodiscard]] Refusal check(const tessera_wire_Alive& alive, const Deployment& deployment);

/// "data of channel a.x->b.y from process 7: the channel does not begin or end there"
[[nodiscard]] std::string description(Refusal refusal, const tessera_wire_Data& data,
                                      const Deployment& deployment);
[[nodiscard]] std::string description(Refusal refusal, const tessera_wire_State& state,
                                      const Deployment& deployment);
[[nodiscard]] std::string description(Refusal refusal, const tessera_wire_Alive& alive,
                                      const Deployment& deployment);

}  // namespace tessera::dds
