#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "explore/budget.hpp"
#include "explore/formula.hpp"
#include "net/net.hpp"
#include "verify/search/numbered_part.hpp"
#include "verify/search/part_lists.hpp"
#include "verify/search/partial_net.hpp"
#include "verify/search/surroundings.hpp"
#include "verify/search/token_sets.hpp"

namespace tessera::verify {

/// Questions to a net that some subsystems settle, whatever the others do (partial_net.hpp).
///
/// It begins with the subsystems that the question is about. If they do not settle it, those who might help are added.
/// First, places count as one where they may (folded_part.hpp, merged_places.hpp); then each counts for itself. Parts
/// that are equal but for the names of their places and subsystems are searched once.
///
/// Precondition: no place of the net ever holds two tokens. Threads: one.
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
  /// From all markings of the net, a run reaches a goal that is about one subsystem: it goes on. If this is not
  /// settled at once, each place is asked about where the token of what it does can be, those of a behaviour together,
  /// if the subsystem always has one. first: as above. Throws explore::CutOff.
  [[nodiscard]] Answer goes_on(net::SubsystemId subsystem, const PartialNet::Goal& goal,
                               const explore::Budget& budget, const Subsystems& first = {}) const;
  /// The subsystems that use a place of a channel.
  [[nodiscard]] Subsystems users(net::PlaceId place) const;

 private:
  enum class Counting : std::uint8_t { folded, merged, each };  ///< of places that may count as one
  /// A question to a part; nullopt: the part does not know what it is about.
  using Ask = std::function<std::optional<NumberedPart>(const PartialNet&)>;

  [[nodiscard]] bool knows(const PartialNet& part, const explore::Formula& formula) const;
  [[nodiscard]] Subsystems owners(const explore::Formula& formula) const;
  /// About what is asked, and how.
  struct About {
    Subsystems subsystems{}, first{};
    std::set<net::PlaceId> asked{};  ///< places that count for themselves
    std::vector<Counting> countings{Counting::folded, Counting::merged, Counting::each};
  };
  [[nodiscard]] Answer reaches(NumberedPart::Question question, const explore::Formula& from,
                               const PartialNet::Goal& goal, About about,
                               const explore::Budget& budget) const;
  [[nodiscard]] Answer from_each_place(net::SubsystemId subsystem, const std::set<net::TransitionId>& fired,
                                       const explore::Budget& budget) const;
  [[nodiscard]] Answer settled(const About& about, const Ask& ask, const explore::Budget& budget) const;
  [[nodiscard]] Answer settled_by(Counting counting, const About& about, const Ask& ask,
                                  const explore::Budget& budget) const;
  [[nodiscard]] const NumberedPart::Result& searched(const NumberedPart& part, const explore::Budget& budget,
                                                     Answer& answer) const;

  const net::Net& net_;
  const Surroundings surroundings_;
  const TokenSets sets_;
  const std::set<net::PlaceId> emptied_;
  const std::size_t few_;
  const PartLists lists_;
  mutable std::unordered_map<std::u32string, NumberedPart::Result> known_{};  // of parts, as they are written
  mutable NumberedPart::Result last_{};                                       // of one that is not kept
};

}  // namespace tessera::verify
