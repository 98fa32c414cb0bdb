#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verify/communication/communication.hpp"
#include "verify/subsystem_at_end.hpp"

namespace tessera::verify {

/// One subsystem waits at a channel for an action of another one.
struct Wait {
  SubsystemFlowId subsystem;
  ChannelFlowId channel;
  Side side = Side::receive;    ///< send: waits for the acknowledgement; receive: for a value
  SubsystemFlowId waiting_for;  ///< none: no behaviour uses the other end
};

/// Subsystems that are joined by channels at which one of them may have to wait.
struct CircuitGroup {
  enum class Cause : std::uint8_t {
    none,        ///< every subsystem goes on
    no_token,    ///< each waits for the next from the start on
    lost_token,  ///< each waits for the next once one side of a channel gave up at the wrong moment
    peer_ended,  ///< a subsystem waits for one that may have ended
    peer_absent  ///< a subsystem waits for one that never uses the channel (again)
  };

  std::vector<SubsystemFlowId> subsystems;
  std::string why_not;  ///< why the criterion does not apply to the group; empty: it applies
  Cause cause = Cause::none;
  std::vector<Wait> circuit;  ///< each waits for the next; in a circuit, the last waits for the first
  std::vector<SubsystemFlowId> stuck;  ///< those that can get stuck for ever, in some reachable marking

  [[nodiscard]] bool applies() const { return why_not.empty(); }
};

enum class Answer : std::uint8_t { yes, no, unknown };

struct CircuitReport {
  std::vector<CircuitGroup> groups;
  Answer goes_on = Answer::unknown;
  Answer deadlock_free = Answer::unknown;
  Answer channels_flow = Answer::unknown;
  std::vector<ChannelFlowId> dry;  ///< channels that can reach a state after which no value is ever received
  std::vector<ChannelFlowId> unclear;  ///< channels that this analysis cannot decide
};

/// Decides goes_on, deadlock_free and channels_flow where every subsystem repeats one cyclic sequence of
/// communications: every subsystem goes on if and only if no circuit of the event graph is free of tokens and
/// none passes an edge that may lose one. Definitions, statement and proof: docs/theory/circuits.md.
///
/// Threads: pure. Linear in the structure.
/// Source: Commoner, Holt, Even, Pnueli, *Marked directed graphs*, JCSS 5, 1971: the case in which
/// every side blocks.
[[nodiscard]] CircuitReport judge_circuits(const CommunicationStructure& structure);

/// The text about a wait at the channel, with the reason if no subsystem ever ends it.
[[nodiscard]] std::string with_absence(std::string text, const ChannelFlow& channel);
/// "robot.control waits to receive from a.y->b.x for robot.motor; ...": a circuit in words.
[[nodiscard]] std::string in_words(const CommunicationStructure& structure, const CircuitGroup& group);
/// The same, one by one.
[[nodiscard]] std::vector<SubsystemAtEnd> at_end(const CommunicationStructure& structure,
                                                 const CircuitGroup& group);

}  // namespace tessera::verify
