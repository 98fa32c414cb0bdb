#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "explore/budget.hpp"
#include "explore/formula.hpp"
#include "net/net.hpp"
#include "verify/search/merged_places.hpp"
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
/// places holds a token, as of a memory that is full or empty, there has to be a step for each of them, or another
/// subsystem can pass this token on alone, as it can after each use of a memory. Whatever the others have done, the
/// subsystems can then go to the goal. So from every marking of the net that is such a marking
/// in these subsystems, the goal is reached by some run.
///
/// Places that count as one (merged_places.hpp) make more runs possible; no step that takes one of them is certain.
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
  struct Result {
    bool holds = false;
    /// Subsystems that might help if they were part of it.
    Subsystems peers{};
    std::uint64_t markings = 0;
  };

  /// surroundings, sets: of the net; have to outlive this. merged: of the subsystems; nullptr: each place counts for
  /// itself.
  PartialNet(const net::Net& net, const Surroundings& surroundings, const TokenSets& sets,
             const Subsystems& subsystems, const MergedPlaces* merged);

  /// Are all places of the formula in this part?
  [[nodiscard]] bool knows(const explore::Formula& formula) const;
  /// No marking that is reached makes it true. Throws explore::CutOff.
  [[nodiscard]] Result never(const explore::Formula& bad, const explore::Budget& budget) const;
  /// From all markings in which `from` holds, and from all that follow before the goal is reached, the goal is reached
  /// for certain. Throws explore::CutOff.
  [[nodiscard]] Result reaches(const explore::Formula& from, const Goal& goal,
                               const explore::Budget& budget) const;

 private:
  friend class PartialGraph;
  struct Step {
    net::TransitionId id{};
    std::vector<std::uint32_t> in, out;  ///< places of the part, sorted
    std::vector<net::PlaceId> needs{};   ///< places that are left out
    bool is_certain = true;              ///< it takes no place that counts as one with others
    bool is_alone =
        false;  ///< needs nothing, and nothing else takes its tokens: whatever comes first, it can be fired
  };
  /// The places of these in the part. step: if given, notes what else it needs.
  [[nodiscard]] std::vector<std::uint32_t> inside(std::span<const net::Arc> arcs, Step* step);
  [[nodiscard]] std::optional<std::uint32_t> place_of(std::uint32_t place) const;

  void add_steps();
  void add_starts();
  void find_lonely_steps();

  const net::Net& net_;
  const Surroundings& surroundings_;
  const TokenSets& sets_;
  const Subsystems subsystems_;
  const MergedPlaces* merged_;
  std::map<std::uint32_t, std::uint32_t> places_;  // of the net -> of the part
  std::set<std::pair<std::uint32_t, std::uint32_t>>
      filled_;                      // places of the net that hold a token first, and theirs
  std::uint32_t places_count_ = 0;  // with those before the start
  std::vector<Step> steps_;
  std::vector<std::vector<std::uint32_t>> takers_;  // per place of the part: steps
  std::vector<std::uint32_t> initial_;
};

}  // namespace tessera::verify
