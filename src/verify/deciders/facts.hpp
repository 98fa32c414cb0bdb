#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "reduce/reduce.hpp"
#include "verify/circuits/circuit_criterion.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/communication/communication.hpp"
#include "verify/deciders/question.hpp"
#include "verify/invariants/unit_invariants.hpp"
#include "verify/search/exploration.hpp"
#include "verify/verify.hpp"
#include "verify/waiting/waiting.hpp"

namespace tessera::verify {

/// Facts about a net under one assumption.
struct NetUnderAssumption {
  net::Net abstract;
  ProbedNet probed;
  CommunicationResult communication;
  std::optional<CircuitReport> circuits;  ///< if there is a communication structure

  NetUnderAssumption(const Subject& subject, Assume assume);

  /// Why the circuit criterion gives no answer.
  [[nodiscard]] std::string why_no_circuits() const;
};

/// Facts about a net that the deciders use. Each fact is computed once, when it is first asked for.
///
/// Threads: one.
class Facts {
 public:
  explicit Facts(const Subject& subject, const reduce::Rules& rules = {});

  [[nodiscard]] const Subject& subject() const { return subject_; }
  /// Mistakes in the invariants; empty: they are invariants of the net.
  [[nodiscard]] const std::vector<std::string>& wrong_invariants() const { return wrong_; }
  /// Do place invariants bound every place by one token? They are emitted by the layers, or computed for a
  /// net of another origin.
  [[nodiscard]] bool safe();
  [[nodiscard]] Reducing reducing() { return {safe(), rules_}; }
  /// Precondition: wrong_invariants() is empty.
  [[nodiscard]] const UnitInvariants& units();
  [[nodiscard]] const NetUnderAssumption& under(Assume assume);
  /// The subsystems that go on for ever, by circuits (docs/circuits.md) or else by waiting (docs/waiting.md).
  /// Precondition: there is a communication structure.
  [[nodiscard]] const WaitingReport& waiting(Assume assume, const explore::Limits& limits);
  /// All subjects of a kind of question.
  [[nodiscard]] std::vector<std::uint32_t> subjects(Question::Kind kind, Assume assume);

 private:
  const Subject& subject_;
  reduce::Rules rules_;
  std::vector<std::string> wrong_;
  std::optional<bool> safe_;
  std::optional<UnitInvariants> units_;
  std::map<Assume, NetUnderAssumption> under_;
  std::map<Assume, WaitingReport> waiting_;
};

/// The place that is marked once the whole system has ended; a net drawn elsewhere has none.
[[nodiscard]] net::PlaceId final_place(const net::Net& net);

/// "robot.control.follow" for a place of that page.
[[nodiscard]] std::string behaviour_of(const net::Net& net, net::PlaceId place);

}  // namespace tessera::verify
