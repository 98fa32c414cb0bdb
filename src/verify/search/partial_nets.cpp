#include "verify/search/partial_nets.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "verify/search/folded_part.hpp"
#include "verify/search/merged_places.hpp"
#include "verify/search/parts.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::PlaceId;

/// Places of subsystems that the layers above empty: their tokens are not followed.
std::set<PlaceId> emptied_from_above(const net::Net& net) {
  std::set<PlaceId> emptied;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    if (!net[net::TransitionId{index}].subsystem.valid())
      for (const net::Arc& arc : net.preset({index}))
        if (!net[arc.place].fused() && std::ranges::count(net.postset({index}), arc) == 0)
          emptied.insert(arc.place);
  return emptied;
}

std::set<PlaceId> all_places_of(const std::vector<const Formula*>& formulas) {
  std::vector<PlaceId> places;
  for (const Formula* formula : formulas) verify::places_of(*formula, places);
  return {places.begin(), places.end()};
}

}  // namespace

PartialNets::PartialNets(const net::Net& net, const std::vector<net::Invariant>& invariants, std::size_t few)
    : net_(net),
      surroundings_(net),
      sets_(net, invariants),
      emptied_(emptied_from_above(net)),
      few_(few),
      lists_(net, surroundings_) {}

PartialNets::Answer PartialNets::never(const Formula& bad, const explore::Budget& budget) const {
  return settled(
      owners(bad), all_places_of({&bad}),
      [&](const PartialNet& part) -> std::optional<NumberedPart> {
        if (!knows(part, bad)) return std::nullopt;
        return part.never(bad);
      },
      budget);
}

PartialNets::Answer PartialNets::reaches(const Formula& from, const PartialNet::Goal& goal,
                                         const explore::Budget& budget, Subsystems begin,
                                         const Subsystems& first) const {
  for (const Formula* formula : {&from, &goal.formula}) begin.merge(owners(*formula));
  std::set<PlaceId> asked = all_places_of({&from, &goal.formula});
  for (const net::TransitionId id : goal.fired)
    for (const net::Arc& arc : net_.preset(id))
      if (!net_[arc.place].fact.valid()) asked.insert(arc.place);
  return settled(
      begin, asked,
      [&](const PartialNet& part) -> std::optional<NumberedPart> {
        if (!knows(part, from) || !knows(part, goal.formula)) return std::nullopt;
        return part.reaches(from, goal);
      },
      budget, first);
}

PartialNets::Subsystems PartialNets::users(PlaceId place) const {
  Subsystems all = surroundings_.users(place);
  std::erase_if(all, [](net::SubsystemId one) { return !one.valid(); });
  return all;
}

bool PartialNets::knows(const PartialNet& part, const Formula& formula) const {
  std::vector<PlaceId> places;
  places_of(formula, places);
  return part.knows(formula) &&
         std::ranges::none_of(places, [&](PlaceId place) { return emptied_.contains(place); });
}

PartialNets::Subsystems PartialNets::owners(const Formula& formula) const {
  std::vector<PlaceId> places;
  places_of(formula, places);
  Subsystems all;
  for (const PlaceId place : places) {
    if (net_[place].fused())
      all.insert(surroundings_.users(place).begin(), surroundings_.users(place).end());
    else
      all.insert(net_[place].subsystem);
  }
  return all;
}

/// asked: places that count for themselves.
PartialNets::Answer PartialNets::settled(const Subsystems& subsystems, const std::set<PlaceId>& asked,
                                         const Ask& ask, const explore::Budget& budget,
                                         const Subsystems& first) const {
  const bool known = std::ranges::all_of(
      subsystems, [&](net::SubsystemId one) { return one.value < net_.parts().subsystems.size(); });
  Answer answer;
  if (!known) return answer;
  for (const Counting counting : {Counting::folded, Counting::merged, Counting::each}) {
    budget.check();
    const Answer one = settled_by(counting, subsystems, asked, ask, budget, first);
    answer.markings += one.markings;
    answer.holds = one.holds;
    if (answer.holds) break;
  }
  return answer;
}

PartialNets::Answer PartialNets::settled_by(Counting counting, Subsystems subsystems,
                                            const std::set<PlaceId>& asked, const Ask& ask,
                                            const explore::Budget& budget, const Subsystems& first) const {
  Answer answer;
  while (!subsystems.empty() && subsystems.size() <= most_subsystems) {
    std::unique_ptr<const Merging> merging;
    if (counting == Counting::merged)
      merging = std::make_unique<MergedPlaces>(net_, surroundings_, subsystems, asked, few_);
    if (counting == Counting::folded) {
      auto folded = std::make_unique<FoldedPart>(net_, surroundings_, lists_, subsystems, asked, few_);
      if (!folded->is_folded()) break;
      merging = std::move(folded);
    }
    const PartialNet part(net_, surroundings_, sets_, subsystems, merging.get());
    const std::optional<NumberedPart> question = ask(part);
    if (!question) break;
    const NumberedPart::Result& result = searched(*question, budget, answer);
    answer.holds = result.holds;
    if (answer.holds) break;
    Subsystems peers = part.users(result.helpful);
    if (std::ranges::any_of(first, [&](net::SubsystemId one) { return peers.contains(one); }))
      std::erase_if(peers, [&](net::SubsystemId one) { return !first.contains(one); });
    if (peers.empty() || subsystems.size() + peers.size() > most_subsystems) break;
    subsystems.insert(peers.begin(), peers.end());
  }
  return answer;
}

/// answer: gets the markings, if the part is not one that is known.
const NumberedPart::Result& PartialNets::searched(const NumberedPart& part, const explore::Budget& budget,
                                                  Answer& answer) const {
  constexpr std::size_t longest = 100'000;
  std::u32string written = part.written();
  if (const auto found = known_.find(written); found != known_.end()) return found->second;
  NumberedPart::Result result = part.searched(budget);
  answer.markings += result.markings;
  if (written.size() > longest) return last_ = std::move(result);
  return known_.emplace(std::move(written), std::move(result)).first->second;
}

}  // namespace tessera::verify
