#include "verify/search/folded_part.hpp"

#include <algorithm>
#include <span>

namespace tessera::verify {

using net::Arc;
using net::PlaceId;
using net::TransitionId;

namespace {

constexpr PlaceId any{};  // in values of alike transitions
constexpr std::size_t most_combinations = 4096;

template <class Id>
void sort_unique_ids(std::vector<Id>& ids) {
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/// Each non-empty subset of a few subsystems.
template <class Do>
void each_subset(const std::set<net::SubsystemId>& all, Do what) {
  const std::vector<net::SubsystemId> row(all.begin(), all.end());
  for (std::uint32_t bits = 1; bits < 1U << row.size(); ++bits) {
    std::set<net::SubsystemId> some;
    for (std::size_t at = 0; at < row.size(); ++at)
      if ((bits >> at & 1U) != 0) some.insert(row[at]);
    what(some);
  }
}

}  // namespace

FoldedPart::FoldedPart(const net::Net& net, const Surroundings& surroundings, const PartLists& lists,
                       const std::set<net::SubsystemId>& subsystems, const std::set<PlaceId>& asked,
                       std::size_t few)
    : net_(net),
      surroundings_(surroundings),
      lists_(lists),
      subsystems_(subsystems),
      asked_(asked),
      few_(few) {
  find_joined();
  find_what_matters();
  find_folded();
  is_smaller_ = !folded_.empty();
  for (const net::SubsystemId one : subsystems_) {
    find_transitions(one);
    find_values(one);
    if (folded_.contains(one)) find_steps(one);
  }
}

void FoldedPart::find_joined() {
  each_subset(subsystems_, [&](const std::set<net::SubsystemId>& some) {
    for (const PlaceId place : lists_.of_channels(some)) joined_.insert(place.value);
  });
}

void FoldedPart::keep_behaviours_of(TransitionId id) {
  for (const auto arcs : {net_.preset(id), net_.postset(id)})
    for (const Arc& arc : arcs)
      if (const net::Place& place = net_[arc.place]; place.behaviour.valid() && !place.fused())
        matters_.emplace(place.subsystem, place.behaviour);
}

void FoldedPart::find_what_matters() {
  const auto keep_users = [&](PlaceId place) {
    for (const TransitionId id : lists_.touching(place))
      if (subsystems_.contains(net_[id].subsystem)) keep_behaviours_of(id);
  };
  for (const std::uint32_t place : joined_) {
    apart_.insert(place);
    keep_users({place});
  }
  for (const PlaceId place : asked_) {
    apart_.insert(place.value);
    if (net_[place].behaviour.valid()) matters_.emplace(net_[place].subsystem, net_[place].behaviour);
    if (net_[place].fused()) keep_users(place);
    if (!net_[place].fact.valid()) continue;
    const auto before = matters_;
    std::set<std::pair<net::SubsystemId, net::BehaviourId>> givers;
    std::swap(matters_, givers);
    for (const TransitionId id : lists_.touching(place)) {
      const auto gives = [&](std::span<const Arc> arcs) {
        return std::ranges::find(arcs, place, &Arc::place) != arcs.end();
      };
      if (gives(net_.postset(id)) && !gives(net_.preset(id))) keep_behaviours_of(id);
      if (matters_.size() > few_) break;
    }
    std::swap(matters_, givers);
    if (givers.size() <= few_) matters_.insert(givers.begin(), givers.end());
  }
}

void FoldedPart::find_folded() {
  std::map<net::SubsystemId, std::size_t> resting;
  for (const net::SubsystemId one : subsystems_)
    if (lists_[one].is_one_token) resting[one] = lists_[one].behaviours.size();
  for (const auto& [subsystem, behaviour] : matters_) {
    if (!subsystems_.contains(subsystem)) continue;
    const auto& behaviours = lists_[subsystem].behaviours;
    const auto found = behaviours.find(behaviour);
    if (found == behaviours.end()) continue;
    for (const PlaceId place : found->second) apart_.insert(place.value);
    if (const auto at = resting.find(subsystem); at != resting.end()) --at->second;
  }
  std::size_t most = few_;
  for (const auto& [one, count] : resting) most = std::max(most, count);
  for (const auto& [one, count] : resting)
    if (count > few_ && 2 * count > most) folded_.insert(one);
}

bool FoldedPart::rests(PlaceId place) const {
  const net::SubsystemId owner = surroundings_.controlled_by(place);
  return owner.valid() && folded_.contains(owner) && !is_apart(place) && lists_.may_merge(place, owner);
}

/// Those that are not the same step as many others.
void FoldedPart::find_transitions(net::SubsystemId subsystem) {
  if (!folded_.contains(subsystem)) return;
  std::vector<TransitionId>& some = transitions_[subsystem];
  some = lists_[subsystem].single;
  const auto add = [&](PlaceId place) {
    for (const TransitionId id : lists_.touching(place))
      if (net_[id].subsystem == subsystem) some.push_back(id);
  };
  for (const std::uint32_t place : apart_)
    if (!net_[PlaceId{place}].fact.valid()) add({place});
  each_subset(subsystems_, [&](const std::set<net::SubsystemId>& users) {
    for (const PlaceId place : lists_.used_by(users)) add(place);
  });
  sort_unique_ids(some);
}

void FoldedPart::find_values(net::SubsystemId subsystem) {
  const SubsystemLists& lists = lists_[subsystem];
  struct Found {
    std::set<PlaceId> given{};
    bool is_joined = false;
  };
  std::map<net::FactId, Found> all;
  for (const PlaceId place : asked_)
    if (lists.facts.contains(net_[place].fact)) all[net_[place].fact];
  for (const net::FactId fact : lists.special) all[fact].given = lists.facts.at(fact).given_first;
  for (const TransitionId id : *(transitions(subsystem) != nullptr ? transitions(subsystem)
                                                                   : &surroundings_.transitions(subsystem))) {
    bool is_joined = false, stands_apart = false;
    for (const auto arcs : {net_.preset(id), net_.postset(id)})
      for (const Arc& arc : arcs) {
        is_joined = is_joined || joined_.contains(arc.place.value);
        stands_apart =
            stands_apart || (surroundings_.controlled_by(arc.place) == subsystem && !rests(arc.place));
      }
    for (const Arc& arc : net_.postset(id)) {
      if (!net_[arc.place].fact.valid()) continue;
      Found& found = all[net_[arc.place].fact];
      if (stands_apart) found.given.insert(arc.place);
      const bool keeps = std::ranges::find(net_.preset(id), arc.place, &Arc::place) != net_.preset(id).end();
      if (is_joined && !keeps) found.is_joined = true;
    }
  }
  for (auto& [fact, found] : all) {
    const SubsystemLists::Fact& one = lists.facts.at(fact);
    Fact& made = facts_[fact.value];
    for (const PlaceId place : one.values)
      if (asked_.contains(place)) made.apart.insert(place);
    const bool is_known = one.is_memory || found.is_joined || !made.apart.empty();
    if (is_known) made.apart.insert(found.given.begin(), found.given.end());
    made.is_merged = one.may_merge() && one.values.size() > made.apart.size() + 1;
    is_smaller_ = is_smaller_ || made.is_merged;
    if (!folded_.contains(subsystem) || !is_known || one.is_memory) continue;
    std::vector<TransitionId>& some = transitions_[subsystem];
    for (const PlaceId place : one.values)
      for (const TransitionId id : lists_.touching(place)) some.push_back(id);
    sort_unique_ids(some);
  }
}

PlaceId FoldedPart::operator[](PlaceId place) const {
  if (rests(place)) return lists_[surroundings_.controlled_by(place)].rest;
  const net::FactId fact = net_[place].fact;
  if (!fact.valid() || !is_merged(place)) return place;
  const auto found = facts_.find(fact.value);
  return found == facts_.end() || found->second.apart.empty() ? PlaceId{} : lists_.stands_for(fact);
}

bool FoldedPart::is_merged(PlaceId place) const {
  const net::FactId fact = net_[place].fact;
  if (!fact.valid()) return rests(place);
  const auto found = facts_.find(fact.value);
  return found == facts_.end() || (found->second.is_merged && !found->second.apart.contains(place));
}

const std::vector<TransitionId>* FoldedPart::transitions(net::SubsystemId one) const {
  const auto found = transitions_.find(one);
  return found == transitions_.end() ? nullptr : &found->second;
}

/// The place for the values that do not count for themselves.
PlaceId FoldedPart::other_value(net::FactId fact) const {
  const Fact& found = facts_.at(fact.value);
  if (found.is_merged) return lists_.stands_for(fact);
  for (const PlaceId place : lists_[net_.parts()[fact].subsystem].facts.at(fact).values)
    if (!found.apart.contains(place)) return place;
  return {};
}

/// Values of a transition as they are counted: other values of a fact are `any`, as are all of one that is left out.
FoldedPart::Places FoldedPart::counted(const Places& values, const SubsystemLists::Alike& alike) const {
  Places result = values;
  for (std::size_t at = 0; at < result.size(); ++at) {
    const net::FactId fact = at < alike.taken.size() ? alike.taken[at] : alike.given[at - alike.taken.size()];
    const auto found = facts_.find(fact.value);
    if (found == facts_.end() || !found->second.apart.contains(result[at])) result[at] = any;
  }
  return result;
}

/// How many transitions have these values, where `any` means one that does not count for itself.
std::size_t FoldedPart::count(const SubsystemLists::Alike& alike, Places& values, std::size_t at) const {
  if (at == values.size()) {
    const auto found = alike.count.find(values);
    return found == alike.count.end() ? 0 : found->second;
  }
  std::size_t result = count(alike, values, at + 1);
  if (values[at].valid()) return result;
  const net::FactId fact = at < alike.taken.size() ? alike.taken[at] : alike.given[at - alike.taken.size()];
  if (const auto found = facts_.find(fact.value); found != facts_.end())
    for (const PlaceId value : found->second.apart) {
      values[at] = value;
      result -= count(alike, values, at + 1);
    }
  values[at] = any;
  return result;
}

void FoldedPart::find_steps(net::SubsystemId subsystem) {
  const SubsystemLists& lists = lists_[subsystem];
  filled_.insert(filled_.end(), lists.filled.begin(), lists.filled.end());
  for (const auto& [number, one] : facts_)
    if (const auto fact = lists.facts.find({number}); fact != lists.facts.end())
      filled_.insert(filled_.end(), fact->second.filled.begin(), fact->second.filled.end());
  std::map<std::uint32_t, std::map<Places, std::size_t>>
      taken;  // alike transitions that are not among the steps
  for (const TransitionId id : transitions_.at(subsystem)) {
    const auto entry = lists.entries.find(id.value);
    if (entry == lists.entries.end()) continue;
    ++taken[entry->second.alike][counted(entry->second.values, lists.alike[entry->second.alike])];
  }
  for (std::uint32_t alike = 0; alike < lists.alike.size(); ++alike)
    add_steps(lists.alike[alike], taken[alike]);
}

void FoldedPart::add_steps(const SubsystemLists::Alike& alike, const std::map<Places, std::size_t>& taken) {
  const std::size_t size = alike.taken.size() + alike.given.size();
  const auto fact_of = [&](std::size_t at) {
    return at < alike.taken.size() ? alike.taken[at] : alike.given[at - alike.taken.size()];
  };
  std::vector<Places> all{Places(size, any)};
  for (std::size_t at = 0; at < size; ++at) {
    const auto found = facts_.find(fact_of(at).value);
    if (found == facts_.end()) continue;
    const std::size_t before = all.size();
    for (const PlaceId value : found->second.apart)
      for (std::size_t index = 0; index < before; ++index) {
        all.push_back(all[index]);
        all.back()[at] = value;
      }
    if (all.size() > most_combinations) {
      has_all_steps_ = false;
      return;
    }
  }
  for (Places& values : all) {
    const auto found = taken.find(values);
    const std::size_t others = found == taken.end() ? 0 : found->second;
    if (count(alike, values, 0) <= others) continue;
    Step step{alike.in, alike.out};
    for (std::size_t at = 0; at < size; ++at) {
      const auto fact = facts_.find(fact_of(at).value);
      if (fact == facts_.end() || (fact->second.apart.empty() && fact->second.is_merged)) continue;
      const PlaceId value = values[at].valid() ? values[at] : other_value(fact_of(at));
      (at < alike.taken.size() ? step.in : step.out).push_back(value);
    }
    steps_.push_back(std::move(step));
  }
}

}  // namespace tessera::verify
