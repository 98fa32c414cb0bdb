#pragma once

#include "net/net.hpp"
#include "spec/model/communication_model.hpp"

namespace tessera::layers {

/// A communication model alone: both sides, the places they share, and for each side a transition by which
/// it sends or receives again and again. Places and transitions are named "send.work", "receive.begin";
/// shared places keep their names. Operations and fused places belong to channel 0. Every element has its
/// line of the specification.
struct ClosedPair {
  net::Net net;
  net::TransitionId sends_again, receives_again;
};
[[nodiscard]] ClosedPair closed_pair(const spec::CommunicationModel& model);

}  // namespace tessera::layers
