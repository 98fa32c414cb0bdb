#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "explore/budget.hpp"
#include "explore/formula.hpp"
#include "net/net.hpp"
#include "verify/search/partial_net.hpp"
#include "verify/search/surroundings.hpp"
#include "verify/search/token_sets.hpp"

namespace tessera::verify {

/// Questions to a net that some subsystems settle, whatever the others do (partial_net.hpp).
///
/// It begins with the subsystems that the question is about. If they do not settle it, those who might help are added.
/// First, places count as one where they may (merged_places.hpp); then each counts for itself.
///
/// Precondition: no place of the net ever holds two tokens. Threads: const members from any thread.
class PartialNets {
 public:
  using Subsystems = PartialNet::Subsystems;
  static constexpr std::size_t most_subsystems = 3;

  /// The net has to outlive this. few: of MergedPlaces. Linear.
  PartialNets(const net::Net& net, const std::vector<net::Invariant>& invariants, std::size_t few = 3);

  struct Answer {
    bool holds = false;  ///< otherwise it is not known
    std::uint64_t markings = 0;
  };
  /// No marking of the net makes it true. Throws explore::CutOff.
  [[nodiscard]] Answer never(const explore::Formula& bad, const explore::Budget& budget) const;
  /// From all markings of the net in which `from` holds, and from all that follow before the goal, a run reaches the
  /// goal. begin: subsystems that the goal is about, besides those of the formulas. first: others that are asked before
  /// all that may help. Throws explore::CutOff.
  [[nodiscard]] Answer reaches(const explore::Formula& from, const PartialNet::Goal& goal,
                               const explore::Budget& budget, Subsystems begin = {},
                               const Subsystems& first = {}) const;
  /// The subsystems that use a place of a channel.
  [[nodiscard]] Subsystems users(net::PlaceId place) const;

 private:
  [[nodiscard]] bool knows(const PartialNet& part, const explore::Formula& formula) const;
  [[nodiscard]] Subsystems owners(const explore::Formula& formula) const;
  template <class Judge>
  Answer settled(const Subsystems& subsystems, const std::set<net::PlaceId>& asked, Judge judge,
                 const Subsystems& first = {}) const;
  template <class Judge>
  Answer settled_by(Subsystems subsystems, const std::set<net::PlaceId>* asked, Judge judge,
                    const Subsystems& first) const;

  const net::Net& net_;
  const Surroundings surroundings_;
  const TokenSets sets_;
  const std::set<net::PlaceId> emptied_;
  const std::size_t few_;
};

}  // namespace tessera::verify
