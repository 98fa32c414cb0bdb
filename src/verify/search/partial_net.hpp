#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "explore/formula.hpp"
#include "net/net.hpp"
#include "verify/search/merging.hpp"
#include "verify/search/numbered_part.hpp"
#include "verify/search/surroundings.hpp"
#include "verify/search/token_sets.hpp"

/// Some subsystems of a net, whatever all others do.
namespace tessera::verify {

/// Questions that some subsystems and the channels between them can settle alone.
///
/// Markings: those of the net without the places of other subsystems and of channels to these. Every run of the net is
/// a run without these places, so what no such run does, no run of the net does.
///
/// Ways: a marking reaches a goal *for certain* if the subsystems have a way to it that needs nothing from the others.
/// A transition that takes no token from a place that is left out is such a step. If exactly one of several such
/// places holds a token, as of a memory that is full or empty, or of values of a fact that is left out, there has to be
/// a step for each of them, or another subsystem can pass this token on alone, as it can after each use of a memory.
/// For steps that need tokens of several such sets there has to be one for each combination. Whatever the others have
/// done, the subsystems can then go to the goal. So from every marking of the net that is such a marking in these
/// subsystems, the goal is reached by some run.
///
/// Places that count as one (merging.hpp) make more runs possible; no step that takes one of them is certain. Those
/// that are left out altogether are as places of others.
///
/// Precondition: no place of the net ever holds two tokens. Steps that lead to two are no steps of the net.
/// Threads: const members from any thread.
class PartialNet {
 public:
  using Subsystems = std::set<net::SubsystemId>;
  /// Markings that reach a goal: those in which the formula holds, or one of the transitions can be fired.
  struct Goal {
    explore::Formula formula = explore::Formula::never();
    std::set<net::TransitionId> fired{};
  };

  /// surroundings, sets: of the net; have to outlive this. merging: of the subsystems; nullptr: each place counts for
  /// itself.
  PartialNet(const net::Net& net, const Surroundings& surroundings, const TokenSets& sets,
             const Subsystems& subsystems, const Merging* merging);

  /// Are all places of the formula in this part?
  [[nodiscard]] bool knows(const explore::Formula& formula) const;
  /// Does no marking that is reached make it true?
  [[nodiscard]] NumberedPart never(const explore::Formula& bad) const;
  /// question: one of those about a goal.
  [[nodiscard]] NumberedPart reaches(NumberedPart::Question question, const explore::Formula& from,
                                     const Goal& goal) const;
  /// Subsystems that are not in the part and use these of the places that are outside of it.
  [[nodiscard]] Subsystems users(const NumberedPart::Numbers& outside) const;

 private:
  using Numbers = NumberedPart::Numbers;
  using Step = NumberedPart::Step;

  /// The places of these in the part. step: if given, notes that it is not certain.
  [[nodiscard]] Numbers inside(std::span<const net::Arc> arcs, Step* step);
  /// Precondition: the place stays in the part.
  [[nodiscard]] bool is_merged(net::PlaceId place) const;
  [[nodiscard]] std::uint32_t number(net::PlaceId place);
  [[nodiscard]] std::optional<std::uint32_t> place_of(std::uint32_t place) const;
  [[nodiscard]] std::uint32_t number_outside(net::PlaceId place);
  [[nodiscard]] explore::Formula numbered(const explore::Formula& formula) const;

  void add_steps();
  void add(net::TransitionId id);
  void add_step(net::TransitionId id, Step step);
  void add_starts();
  void add_sets();
  void find_lonely_steps();

  const net::Net& net_;
  const Surroundings& surroundings_;
  const TokenSets& sets_;
  const Subsystems subsystems_;
  const Merging* merging_;
  std::map<std::uint32_t, std::uint32_t> places_;  // of the net -> of the part
  std::set<std::pair<std::uint32_t, std::uint32_t>>
      filled_;  // places of the net that hold a token first, and theirs
  std::set<std::pair<Numbers, Numbers>> uncertain_{};  // steps that take places that count as one
  std::vector<net::TransitionId> ids_{};  // per step; invalid: of several transitions, or a start
  std::map<net::PlaceId, std::uint32_t> outside_{};
  std::vector<net::PlaceId> places_outside_{};  // by number
  NumberedPart part_{};                         // without a question
};

}  // namespace tessera::verify
