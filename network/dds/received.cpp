#include "network/dds/received.hpp"

#include <algorithm>

namespace tessera::dds {
namespace {

const char* reason(Refusal refusal) {
  switch (refusal) {
    case Refusal::none:
      return "";
    case Refusal::unknown_channel:
      return "this process has no such channel";
    case Refusal::wrong_process:
      return "the channel does not begin or end there";
    case Refusal::wrong_direction:
      return "the channel goes the other way";
    case Refusal::no_incarnation:
      return "its incarnation is 0";
    case Refusal::no_number:
      return "the value has the number 0";
    case Refusal::state_of_nothing:
      return "it acknowledges a value of no sender";
    case Refusal::recall_with_value:
      return "a recall with a value";
    case Refusal::too_large:
      return "the value is longer than any of this channel";
    case Refusal::time_before_zero:
      return "it was written before time 0";
    case Refusal::no_peer:
      return "no channel joins that process and this one";
  }
  return "";
}

std::string text(const char* kind, std::uint32_t channel_number, std::uint32_t process, Refusal refusal,
                 const Deployment& deployment) {
  const Channel* channel = deployment.channel(channel_number);
  const std::string name = channel == nullptr ? std::to_string(channel_number) : channel->name;
  return std::string(kind) + " of channel " + name + " from process " + std::to_string(process) + ": " +
         reason(refusal);
}

}  // namespace

Refusal check(const tessera_wire_Data& data, const Deployment& deployment) {
  const Channel* channel = deployment.channel(data.channel);
  if (channel == nullptr) return Refusal::unknown_channel;
  if (channel->receiver != deployment.process) return Refusal::wrong_direction;
  if (channel->sender != data.process) return Refusal::wrong_process;
  if (data.from_incarnation == 0) return Refusal::no_incarnation;
  if (data.number == 0) return Refusal::no_number;
  if (data.recall) return data.bytes._length == 0 ? Refusal::none : Refusal::recall_with_value;
  if (data.bytes._length > channel->longest_value_bytes) return Refusal::too_large;
  return data.stamp_ns < 0 ? Refusal::time_before_zero : Refusal::none;
}

Refusal check(const tessera_wire_State& state, const Deployment& deployment) {
  const Channel* channel = deployment.channel(state.channel);
  if (channel == nullptr) return Refusal::unknown_channel;
  if (channel->sender != deployment.process) return Refusal::wrong_direction;
  if (channel->receiver != state.process) return Refusal::wrong_process;
  if (state.from_incarnation == 0) return Refusal::no_incarnation;
  return state.peer_incarnation == 0 && state.taken != 0 ? Refusal::state_of_nothing : Refusal::none;
}

Refusal check(const tessera_wire_Alive& alive, const Deployment& deployment) {
  if (!std::ranges::binary_search(deployment.peers, alive.process)) return Refusal::no_peer;
  return alive.incarnation == 0 ? Refusal::no_incarnation : Refusal::none;
}

std::string description(Refusal refusal, const tessera_wire_Data& data, const Deployment& deployment) {
  return text("data", data.channel, data.process, refusal, deployment);
}

std::string description(Refusal refusal, const tessera_wire_State& state, const Deployment& deployment) {
  return text("a state", state.channel, state.process, refusal, deployment);
}

std::string description(Refusal refusal, const tessera_wire_Alive& alive, const Deployment& /*deployment*/) {
  return "a sign of life of process " + std::to_string(alive.process) + ": " + reason(refusal);
}

}  // namespace tessera::dds
