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
  const Ask ask = [&](const PartialNet& part) -> std::optional<NumberedPart> {
    if (!knows(part, bad)) return std::nullopt;
    return part.never(bad);
  };
  return settled({.subsystems = owners(bad), .asked = all_places_of({&bad})}, ask, budget);
}

PartialNets::Answer PartialNets::reaches(const Formula& from, const PartialNet::Goal& goal,
                                         const explore::Budget& budget, Subsystems begin,
                                         const Subsystems& first) const {
  return reaches(NumberedPart::Question::reaches, from, goal,
                 {.subsystems = std::move(begin), .first = first}, budget);
}

PartialNets::Answer PartialNets::reaches(NumberedPart::Question question, const Formula& from,
                                         const PartialNet::Goal& goal, About about,
                                         const explore::Budget& budget) const {
  for (const Formula* formula : {&from, &goal.formula}) about.subsystems.merge(owners(*formula));
  about.asked = all_places_of({&from, &goal.formula});
  for (const net::TransitionId id : goal.fired)
    for (const net::Arc& arc : net_.preset(id))
      if (!net_[arc.place].fact.valid()) about.asked.insert(arc.place);
  const Ask ask = [&](const PartialNet& part) -> std::optional<NumberedPart> {
    if (!knows(part, from) || !knows(part, goal.formula)) return std::nullopt;
    return part.reaches(question, from, goal);
  };
  return settled(about, ask, budget);
}

PartialNets::Answer PartialNets::goes_on(net::SubsystemId subsystem, const PartialNet::Goal& goal,
                                         const explore::Budget& budget, const Subsystems& first) const {
  const auto at_once = [&](std::vector<Counting> countings) {
    return reaches(
        NumberedPart::Question::can_reach, Formula::always(), goal,
        {.subsystems = {subsystem}, .first = first, .asked = {}, .countings = std::move(countings)}, budget);
  };
  Answer answer = at_once({Counting::folded});
  const auto then = [&](const Answer& next) {
    answer.holds = next.holds;
    answer.markings += next.markings;
  };
  if (!answer.holds) then(from_each_place(subsystem, goal.fired, budget));
  if (!answer.holds) then(at_once({Counting::merged, Counting::each}));
  return answer;
}

PartialNets::Answer PartialNets::from_each_place(net::SubsystemId subsystem,
                                                 const std::set<net::TransitionId>& fired,
                                                 const explore::Budget& budget) const {
  const SubsystemLists& lists = lists_[subsystem];
  std::vector<std::vector<PlaceId>> all;
  for (const auto& [behaviour, places] : lists.behaviours) all.push_back(places);
  for (const PlaceId place : lists.others) all.push_back({place});
  Answer answer;
  if (!lists.keeps_token) return answer;
  for (const std::vector<PlaceId>& places : all) {
    std::vector<Formula> from;
    PartialNet::Goal goal;
    for (const PlaceId place : places) {
      if (emptied_.contains(place)) return answer;
      from.push_back(Formula::marked(place));
      for (const net::TransitionId id : lists_.touching(place))
        if (fired.contains(id)) goal.fired.insert(id);
    }
    const Answer one = reaches(
        NumberedPart::Question::can_reach, Formula::any(std::move(from)), goal,
        {.subsystems = {subsystem}, .first = {}, .asked = {}, .countings = {Counting::folded}}, budget);
    answer.markings += one.markings;
    if (!one.holds) return answer;
  }
  answer.holds = true;
  return answer;
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

PartialNets::Answer PartialNets::settled(const About& about, const Ask& ask,
                                         const explore::Budget& budget) const {
  const bool known = std::ranges::all_of(
      about.subsystems, [&](net::SubsystemId one) { return one.value < net_.parts().subsystems.size(); });
  Answer answer;
  if (!known) return answer;
  for (const Counting counting : about.countings) {
    budget.check();
    const Answer one = settled_by(counting, about, ask, budget);
    answer.markings += one.markings;
    answer.holds = one.holds;
    if (answer.holds) break;
  }
  return answer;
}

PartialNets::Answer PartialNets::settled_by(Counting counting, const About& about, const Ask& ask,
                                            const explore::Budget& budget) const {
  Answer answer;
  Subsystems subsystems = about.subsystems;
  while (!subsystems.empty() && subsystems.size() <= most_subsystems) {
    std::unique_ptr<const Merging> merging;
    if (counting == Counting::merged)
      merging = std::make_unique<MergedPlaces>(net_, surroundings_, subsystems, about.asked, few_);
    if (counting == Counting::folded) {
      auto folded = std::make_unique<FoldedPart>(net_, surroundings_, lists_, subsystems, about.asked, few_);
      if (!folded->is_made()) break;
      if (folded->is_smaller()) merging = std::move(folded);
    }
    const PartialNet part(net_, surroundings_, sets_, subsystems, merging.get());
    const std::optional<NumberedPart> question = ask(part);
    if (!question) break;
    const NumberedPart::Result& result = searched(*question, budget, answer);
    answer.holds = result.holds;
    if (answer.holds) break;
    Subsystems peers = part.users(result.helpful);
    if (std::ranges::any_of(about.first, [&](net::SubsystemId one) { return peers.contains(one); }))
      std::erase_if(peers, [&](net::SubsystemId one) { return !about.first.contains(one); });
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
