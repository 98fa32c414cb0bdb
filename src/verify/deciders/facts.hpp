#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
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
#include "verify/search/partial_nets.hpp"
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
  /// Parts of the probed net. Precondition: safe().
  [[nodiscard]] const PartialNets& partial_nets(Assume assume);
  /// The subsystems that go on for ever, by circuits (docs/theory/circuits.md) or else by waiting
  /// (docs/theory/waiting.md). Precondition: there is a communication structure. If there was not enough
  /// time for it before, it is tried again only if there is twice as much now.
  [[nodiscard]] const WaitingReport& waiting(Assume assume, const explore::Limits& limits);
  /// Is a dead marking reachable that is not final? yes: with a run of the abstract net. Searched for once, as
  /// `waiting` is.
  [[nodiscard]] const Found& dead_end(Assume assume, const explore::Limits& limits);
  /// Another method has proved that there is none.
  void exclude_dead_ends(Assume assume) { excluded_.insert(assume); }
  [[nodiscard]] bool dead_ends_are_excluded(Assume assume) const { return excluded_.contains(assume); }
  /// Runs to dead markings that were found before under any assumption, and that are such runs under this
  /// one.
  [[nodiscard]] std::vector<std::vector<net::TransitionId>> known_dead_ends(Assume assume);
  /// All subjects of a kind of question.
  [[nodiscard]] std::vector<std::uint32_t> subjects(Question::Kind kind, Assume assume);

 private:
  const Subject& subject_;
  reduce::Rules rules_;
  std::vector<std::string> wrong_;
  std::optional<bool> safe_;
  std::optional<UnitInvariants> units_;
  /// The finding of a search, and its limits.
  template <class Result>
  struct Searched {
    Result result{};
    bool decided = false;
    std::chrono::duration<double> time{};
    std::uint64_t markings = 0;

    /// Would another search find no more?
    [[nodiscard]] bool suffices(const explore::Limits& limits) const {
      return decided || (limits.time < 2 * time && limits.markings <= markings);
    }
    void note(const explore::Limits& limits, bool is_decided) {
      decided = is_decided;
      time = limits.time;
      markings = limits.markings;
    }
  };

  std::map<Assume, NetUnderAssumption> under_;
  std::map<Assume, PartialNets> partial_nets_;
  std::map<Assume, Searched<WaitingReport>> waiting_;
  std::map<Assume, Searched<Found>> dead_ends_;
  std::set<Assume> excluded_;
};

/// The place that is marked once the whole system has ended; a net drawn elsewhere has none.
[[nodiscard]] net::PlaceId final_place(const net::Net& net);

/// "robot.control.follow" for a place of that page.
[[nodiscard]] std::string behaviour_of(const net::Net& net, net::PlaceId place);

}  // namespace tessera::verify
