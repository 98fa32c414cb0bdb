#pragma once

#include "net/net.hpp"
#include "spec/model/communication_model.hpp"

namespace tessera::layers {

/// A communication model alone: both sides, the places they share, and for each side a user who sends or
/// receives again and again. Places and transitions are named "send.work", "receive.begin"; shared places by
/// their names. Operations and fused places are of channel 0; every element has its line of the
/// specification.
struct ClosedPair {
  net::Net net;
  net::TransitionId sends_again, receives_again;
};
[[nodiscard]] ClosedPair closed_pair(const spec::CommunicationModel& model);

}  // namespace tessera::layers
