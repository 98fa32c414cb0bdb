#include "verify/search/partial_net.hpp"

#include <algorithm>
#include <utility>

#include "verify/search/parts.hpp"

namespace tessera::verify {

using explore::Formula;
using net::Arc;
using net::PlaceId;

PartialNet::PartialNet(const net::Net& net, const Surroundings& surroundings, const TokenSets& sets,
                       const Subsystems& subsystems, const Merging* merging)
    : net_(net), surroundings_(surroundings), sets_(sets), subsystems_(subsystems), merging_(merging) {
  add_steps();
  part_.places = static_cast<std::uint32_t>(places_.size());
  add_starts();
  find_lonely_steps();
  add_sets();
}

std::uint32_t PartialNet::number(PlaceId place) {
  return places_.try_emplace(place.value, static_cast<std::uint32_t>(places_.size())).first->second;
}

std::optional<std::uint32_t> PartialNet::place_of(std::uint32_t place) const {
  const auto found = places_.find(place);
  return found == places_.end() ? std::nullopt : std::optional(found->second);
}

bool PartialNet::is_merged(PlaceId place) const { return merging_ != nullptr && merging_->is_merged(place); }

PartialNet::Numbers PartialNet::inside(std::span<const Arc> arcs, Step* step) {
  Numbers there;
  for (const Arc& arc : arcs) {
    if (!surroundings_.stays(arc.place, subsystems_)) continue;
    PlaceId place = arc.place;
    if (is_merged(place)) {
      place = (*merging_)[place];
      if (!place.valid()) continue;
      if (step != nullptr) step->is_certain = false;
    }
    there.push_back(number(place));
    if (net_[arc.place].tokens > 0 || surroundings_.is_started(arc.place))
      filled_.emplace(arc.place.value, there.back());
  }
  std::ranges::sort(there);
  return there;
}

void PartialNet::add_steps() {
  for (const net::SubsystemId subsystem : subsystems_) {
    const std::vector<net::TransitionId>* some =
        merging_ == nullptr ? nullptr : merging_->transitions(subsystem);
    for (const net::TransitionId id : some != nullptr ? *some : surroundings_.transitions(subsystem)) add(id);
  }
  if (merging_ == nullptr) return;
  for (const Merging::Step& one : merging_->steps()) {
    Step step{.is_certain = false};
    for (const PlaceId place : one.in) step.in.push_back(number(place));
    for (const PlaceId place : one.out) step.out.push_back(number(place));
    std::ranges::sort(step.in);
    std::ranges::sort(step.out);
    add_step({}, std::move(step));
  }
  for (const PlaceId place : merging_->filled())
    if (const PlaceId counted = (*merging_)[place]; counted.valid())
      if (const auto here = place_of(counted.value)) filled_.emplace(place.value, *here);
}

void PartialNet::add(net::TransitionId id) {
  Step step;
  step.in = inside(net_.preset(id), &step);
  step.out = inside(net_.postset(id), nullptr);
  if (step.in.empty() && step.out.empty()) return;
  if (step.is_certain)
    for (const Arc& arc : net_.preset(id))
      if (!surroundings_.stays(arc.place, subsystems_) ||
          (is_merged(arc.place) && !(*merging_)[arc.place].valid()))
        step.needs.push_back(number_outside(arc.place));
  add_step(id, std::move(step));
}

/// Several transitions between places that count as one may be the same step.
void PartialNet::add_step(net::TransitionId id, Step step) {
  if (!step.is_certain && (step.in == step.out || !uncertain_.emplace(step.in, step.out).second)) return;
  part_.steps.push_back(std::move(step));
  ids_.push_back(id);
}

std::uint32_t PartialNet::number_outside(PlaceId place) {
  const auto [entry, added] = outside_.try_emplace(place, static_cast<std::uint32_t>(places_outside_.size()));
  if (added) places_outside_.push_back(place);
  return entry->second;
}

/// The layers above start each subsystem at some time, before which it has no token.
void PartialNet::add_starts() {
  for (const auto& [place, number] : filled_) {
    if (net_.places()[place].tokens > 0) part_.initial.push_back(number);
    if (!surroundings_.is_started({place})) continue;
    part_.initial.push_back(part_.places);
    part_.steps.push_back({.in = {part_.places++}, .out = {number}});
    ids_.emplace_back();
  }
  std::ranges::sort(part_.initial);
}

void PartialNet::find_lonely_steps() {
  std::vector<bool> shared(part_.places, false);
  for (const auto& [place, number] : places_)
    if (place >= net_.places().size() || net_.places()[place].fused() || net_.places()[place].fact.valid())
      shared[number] = true;
  std::vector<std::uint32_t> takers(part_.places, 0);
  for (const Step& step : part_.steps)
    for (const std::uint32_t place : step.in) ++takers[place];
  for (Step& step : part_.steps) {
    const auto is_mine = [&](std::uint32_t place) { return takers[place] == 1; };
    const auto is_shared = [&](std::uint32_t place) { return shared[place]; };
    step.is_alone = step.needs.empty() && step.is_certain && !step.in.empty() &&
                    std::ranges::all_of(step.in, is_mine) && std::ranges::none_of(step.out, is_shared);
  }
}

/// The sets by which steps that need one place outside may go on wherever its token is.
void PartialNet::add_sets() {
  const std::size_t needed = places_outside_.size();
  std::map<std::size_t, std::uint32_t> numbers;
  std::vector<Numbers> sets_of(needed);
  for (std::size_t outside = 0; outside < needed; ++outside)
    for (const std::size_t set : sets_.with(places_outside_[outside])) {
      const auto [entry, added] = numbers.try_emplace(set, static_cast<std::uint32_t>(part_.sets.size()));
      sets_of[outside].push_back(entry->second);
      if (!added) continue;
      const std::vector<PlaceId>& places = sets_[set];
      NumberedPart::Set members;
      for (const PlaceId place : places) {
        const auto here = place_of(place.value);
        members.push_back({.is_outside = !here, .place = here ? *here : number_outside(place)});
      }
      for (std::size_t member = 0; member < places.size(); ++member)
        for (const PlaceId next : sets_.next(places[member]))
          if (const auto at = std::ranges::find(places, next);
              members[member].is_outside && at != places.end() && !place_of(next.value))
            members[member].next.push_back(static_cast<std::uint32_t>(at - places.begin()));
      part_.sets.push_back(std::move(members));
    }
  part_.sets_of = std::move(sets_of);
}

bool PartialNet::knows(const Formula& formula) const {
  std::vector<PlaceId> all;
  places_of(formula, all);
  return std::ranges::all_of(all, [&](PlaceId place) {
    return places_.contains(place.value) || surroundings_.stays(place, subsystems_);
  });
}

/// A place that no step of the part changes keeps its tokens.
Formula PartialNet::numbered(const Formula& formula) const {
  if (formula.kind == Formula::Kind::at_least) {
    if (const auto here = place_of(formula.node)) return Formula::marked({*here});
    return surroundings_.tokens({formula.node}) > 0 ? Formula::always() : Formula::never();
  }
  Formula result = formula;
  for (Formula& part : result.parts) part = numbered(part);
  return result;
}

NumberedPart PartialNet::never(const Formula& bad) const {
  NumberedPart part = part_;
  part.question = NumberedPart::Question::never;
  part.from = numbered(bad);
  part.goal = Formula::never();
  return part;
}

NumberedPart PartialNet::reaches(NumberedPart::Question question, const Formula& from,
                                 const Goal& goal) const {
  NumberedPart part = part_;
  part.question = question;
  part.from = numbered(from);
  part.goal = numbered(goal.formula);
  for (std::size_t step = 0; step < part.steps.size(); ++step)
    part.steps[step].is_goal = ids_[step].valid() && goal.fired.contains(ids_[step]);
  return part;
}

PartialNet::Subsystems PartialNet::users(const Numbers& outside) const {
  Subsystems all;
  for (const std::uint32_t number : outside)
    for (const net::SubsystemId user : surroundings_.users(places_outside_[number]))
      if (user.valid() && !subsystems_.contains(user)) all.insert(user);
  return all;
}

}  // namespace tessera::verify
