#pragma once

#include <string>

#include "net/net.hpp"
#include "spec/model/model.hpp"
#include "verify/circuits/circuit_criterion.hpp"

namespace tessera::test {

/// The flat net of a model. Throws if the model is refused.
[[nodiscard]] net::Net flat_net(const spec::Model& model);

struct Judged {
  verify::CommunicationStructure structure;
  verify::CircuitReport report;
};
/// Throws if the net is not of the shape of the five layers.
[[nodiscard]] Judged judge(const net::Net& net, verify::Assume assume = verify::Assume::conditions);
[[nodiscard]] Judged judge(const spec::Model& model, verify::Assume assume = verify::Assume::conditions);

/// The structure on a few lines, for the messages of failed tests and for tests of the structure itself:
/// "a0.s0 b0: !0~ [?1 | ?2] -> b1 end" sends on channel 0, blocking (!) with a timeout (~), then receives
/// from two channels side by side; "repeats" and what may follow come last.
[[nodiscard]] std::string in_text(const verify::CommunicationStructure& structure);

}  // namespace tessera::test
