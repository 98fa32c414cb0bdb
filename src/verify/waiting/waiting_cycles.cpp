#include "verify/waiting/waiting_cycles.hpp"

#include <algorithm>
#include <utility>

#include "verify/circuits/recurring_uses.hpp"

namespace tessera::verify {

using siphons::PlaceSet;

WaitingCycleSearch::WaitingCycleSearch(const CommunicationStructure& structure,
                                       std::span<const SubsystemFlowId> subsystems, explore::Watch& watch)
    : structure_(structure),
      skeleton_(structure, subsystems),
      net_(skeleton_.net()),
      clauses_(watch),
      stops_of_(structure.subsystems.size()),
      stuck_(structure.subsystems.size(), 0) {
  for (std::uint32_t stop = 0; stop < all().size(); ++stop) {
    stops_of_[all()[stop].subsystem.value].push_back(stop);
    at_.push_back(clauses_.variable());
  }
  find_partners();
  state_waits(subsystems);
  state_exclusions();
}

void WaitingCycleSearch::find_partners() {
  const RecurringUses uses(structure_);
  for (const Stop& stop : all()) {
    const ChannelFlow& channel = structure_[stop.channel];
    const bool sends = stop.side == Side::send;
    const SubsystemFlowId partner = sends ? channel.receiver : channel.sender;
    partner_.push_back(partner);
    deserts_.push_back(!partner.valid() ||
                       !uses.comes_back(stop.channel, sends ? Side::receive : Side::send));
  }
}

/// A stuck subsystem is at a stop. The subsystem that it waits for is stuck too, unless that one need not
/// come back anyway.
void WaitingCycleSearch::state_waits(std::span<const SubsystemFlowId> subsystems) {
  std::vector<int> somebody;
  for (const SubsystemFlowId subsystem : subsystems) {
    stuck_[subsystem.value] = clauses_.variable();
    somebody.push_back(stuck_[subsystem.value]);
  }
  clauses_.add(somebody);
  for (const SubsystemFlowId subsystem : subsystems) {
    std::vector<int> somewhere{-stuck_[subsystem.value]};
    for (const std::uint32_t stop : stops_of_[subsystem.value]) {
      somewhere.push_back(at_[stop]);
      clauses_.add({-at_[stop], stuck_[subsystem.value]});
      if (!deserts_[stop]) clauses_.add({-at_[stop], stuck_[partner_[stop].value]});
    }
    clauses_.add(somewhere);
  }
}

/// A subsystem is at one stop, or at several of one stage; and a channel is empty for a waiting receiver, but
/// full for a waiting sender.
void WaitingCycleSearch::state_exclusions() {
  std::map<ChannelFlowId, Stops> senders, receivers;
  for (std::uint32_t stop = 0; stop < all().size(); ++stop) {
    const Stop& one = all()[stop];
    (one.side == Side::send ? senders : receivers)[one.channel].push_back(stop);
  }
  for (const Stops& own : stops_of_) state_one_stage(own);
  for (const auto& [channel, sending] : senders)
    for (const std::uint32_t sender : sending)
      for (const std::uint32_t receiver : receivers[channel]) clauses_.add({-at_[sender], -at_[receiver]});
}

/// The stops of a subsystem, in the order of their stages: a chain of "at one of the first n stages", since
/// a hub has thousands of stages.
void WaitingCycleSearch::state_one_stage(const Stops& stops) {
  int before = 0;
  for (auto first = stops.begin(); first != stops.end();) {
    const auto last = std::find_if(
        first, stops.end(), [&](std::uint32_t stop) { return all()[stop].stage != all()[*first].stage; });
    int here = at_[*first];
    if (last - first > 1) {
      here = clauses_.variable();
      for (auto stop = first; stop != last; ++stop) clauses_.add({-at_[*stop], here});
    }
    first = last;
    if (before != 0) clauses_.add({-before, -here});
    if (first == stops.end()) return;
    const int now = clauses_.variable();
    clauses_.add({-here, now});
    if (before != 0) clauses_.add({-before, now});
    before = now;
  }
}

void WaitingCycleSearch::give_up_on(std::span<const SubsystemFlowId> subsystems) {
  for (const SubsystemFlowId subsystem : subsystems) clauses_.add({-stuck_[subsystem.value]});
}

WaitingCycleSearch::End WaitingCycleSearch::run() {
  while (true) {
    suspected_.clear();
    const siphons::Clauses::Answer answer = clauses_.solve();
    if (answer == siphons::Clauses::Answer::contradiction) return End::excluded;
    if (answer == siphons::Clauses::Answer::gave_up) return End::gave_up;
    const Stops everything = all_occupied();
    const std::vector<Stops> found = cycles();
    std::size_t refined = 0;
    for (const Stops& cycle : found)
      if (refine(cycle)) ++refined;
    // A trap through more than one cycle may be what excludes them.
    if (refined == 0 && !refine(everything)) return End::suspected;
  }
}

WaitingCycleSearch::Stops WaitingCycleSearch::all_occupied() const {
  Stops stops;
  for (std::uint32_t stop = 0; stop < all().size(); ++stop)
    if (occupied(stop)) stops.push_back(stop);
  return stops;
}

/// Cycles without common subsystems, found by going from each stop to a stop of the subsystem that it waits
/// for; and single stops that wait for a subsystem that need not come back.
std::vector<WaitingCycleSearch::Stops> WaitingCycleSearch::cycles() const {
  std::vector<Stops> found;
  std::vector<bool> passed(stops_of_.size(), false);  // per subsystem
  for (std::uint32_t start = 0; start < all().size(); ++start) {
    if (!occupied(start)) continue;
    Stops walk;
    std::uint32_t stop = start;
    while (!passed[all()[stop].subsystem.value]) {
      passed[all()[stop].subsystem.value] = true;
      walk.push_back(stop);
      if (deserts_[stop]) break;
      const Stops& next = stops_of_[partner_[stop].value];
      stop = *std::ranges::find_if(next, [&](std::uint32_t candidate) { return occupied(candidate); });
    }
    if (walk.empty()) continue;
    if (deserts_[walk.back()]) {
      found.push_back({walk.back()});
      continue;
    }
    const auto begin = std::ranges::find_if(
        walk, [&](std::uint32_t earlier) { return all()[earlier].subsystem == all()[stop].subsystem; });
    if (begin != walk.end()) found.emplace_back(begin, walk.end());
  }
  return found;
}

/// Places without a token while subsystems are stuck at these stops.
PlaceSet WaitingCycleSearch::empty_at(const Stops& stops) const {
  PlaceSet empty(net_.places(), 0);
  for (const std::uint32_t stop : stops) {
    for (const std::uint32_t place : skeleton_.of_subsystem(all()[stop].subsystem)) empty[place] = 1;
    empty[skeleton_.awaited(all()[stop])] = 1;
  }
  for (const std::uint32_t stop : stops) {
    empty[all()[stop].place] = 0;
    for (const std::uint32_t place : all()[stop].beside) empty[place] = 0;
  }
  return empty;
}

/// Looks for a trap that cannot be empty, but would be at these stops, and states that. False: there is none,
/// and the stops are suspected.
bool WaitingCycleSearch::refine(const Stops& stops) {
  const std::vector<std::uint32_t> places = siphons::small_marked_trap(net_, empty_at(stops));
  if (places.empty()) {
    suspect(stops);
    return false;
  }
  ++traps_;
  PlaceSet trap(net_.places(), 0);
  for (const std::uint32_t place : places) trap[place] = 1;
  std::vector<int> not_all;
  for (const std::uint32_t stop : stops) {
    const bool concerned = trap[skeleton_.awaited(all()[stop])] != 0 ||
                           std::ranges::any_of(skeleton_.of_subsystem(all()[stop].subsystem),
                                               [&](std::uint32_t place) { return trap[place] != 0; });
    if (concerned) not_all.push_back(-leaving_empty(trap, stop));
  }
  clauses_.add(not_all);
  return true;
}

/// "At this stop, or at another one of the subsystem at which the trap is as empty."
int WaitingCycleSearch::leaving_empty(const PlaceSet& trap, std::uint32_t stop) {
  const auto in_trap = [&](std::uint32_t place) { return trap[place] != 0; };
  const std::uint32_t awaited = skeleton_.awaited(all()[stop]);
  Stops as_empty;
  for (const std::uint32_t other : stops_of_[all()[stop].subsystem.value]) {
    const Stop& one = all()[other];
    const bool awaits_enough = !in_trap(awaited) || skeleton_.awaited(one) == awaited;
    if (awaits_enough && !in_trap(one.place) && std::ranges::none_of(one.beside, in_trap))
      as_empty.push_back(other);
  }
  if (as_empty.size() == 1) return at_[stop];
  const auto [entry, added] = one_of_.try_emplace(as_empty, 0);
  if (!added) return entry->second;
  entry->second = clauses_.variable();
  for (const std::uint32_t other : as_empty) clauses_.add({-at_[other], entry->second});
  return entry->second;
}

/// Keeps the suspicion with the fewest waits.
void WaitingCycleSearch::suspect(const Stops& stops) {
  if (!suspected_.empty() && suspected_.size() <= stops.size()) return;
  suspected_.clear();
  for (const std::uint32_t stop : stops)
    suspected_.push_back({all()[stop].subsystem, all()[stop].channel, all()[stop].side, partner_[stop]});
  deserted_ = deserts_[stops.front()];
}

}  // namespace tessera::verify
