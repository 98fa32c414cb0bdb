#include "verify/counterexample/waits.hpp"

#include <algorithm>
#include <utility>

#include "net/token_game.hpp"

namespace tessera::verify {
namespace {

using net::TransitionId;

}  // namespace

Waits::Good Waits::good_of(const net::Place& place) const {
  if (place.role == PlaceRole::full) return Good::value;
  if (place.fused() && crosses(place)) return Good::acknowledgement;
  return place.role == PlaceRole::acknowledged ? Good::acknowledgement : Good::memory;
}

/// Over a network a value arrives if its sender sends it, and it was taken if its receiver has an empty slot.
bool Waits::is_given(std::uint32_t place, const net::Arc& arc) const {
  const net::Place& wanted = net_.places()[place];
  const net::Place& given = net_[arc.place];
  if (!wanted.fused() || !crosses(wanted)) return arc.place.value == place;
  if (given.channel != wanted.channel) return false;
  if (good_of(wanted) == Good::value) return given.role == PlaceRole::sent || given.role == PlaceRole::more;
  return given.role == PlaceRole::empty;
}

std::string Waits::cut_at(const net::Place& place) const {
  if (!place.fused() || !crosses(place)) return {};
  const bool back = good_of(place) == Good::acknowledgement;
  for (std::uint32_t link = 0; link < tokens_.size(); ++link) {
    const net::Place& one = net_.places()[link];
    if (one.channel != place.channel || tokens_[link] > 0) continue;
    if (one.role == PlaceRole::link || (back && one.role == PlaceRole::link_back))
      return ", and the network is cut";
  }
  return {};
}

Waits::Waits(const net::Net& net, std::vector<std::uint32_t> tokens)
    : net_(net),
      tokens_(std::move(tokens)),
      transitions_(net.parts().subsystems.size()),
      networked_(net.parts().channels.size(), false) {
  for (const net::Place& place : net.places())
    if (is_networked(place.role)) networked_[place.channel.value] = true;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::Transition& transition = net.transitions()[index];
    if (transition.subsystem.value >= transitions_.size() ||
        transition.condition.truth == net::Condition::Truth::never)
      continue;
    transitions_[transition.subsystem.value].push_back({index});
    for (const net::Arc& arc : net.postset({index})) {
      if (!net[arc.place].fused()) continue;
      std::vector<TransitionId>& giving = giving_[net[arc.place].channel];
      if (giving.empty() || giving.back() != TransitionId{index}) giving.push_back({index});
    }
  }
  note_tokens();
}

void Waits::note_tokens() {
  acts_.assign(transitions_.size(), false);
  std::set<net::AgentId> not_begun;
  bool system_not_begun = false;
  for (std::uint32_t place = 0; place < tokens_.size(); ++place) {
    if (tokens_[place] == 0) continue;
    const net::Place& given = net_.places()[place];
    if (given.subsystem.value < acts_.size() && !given.fused() &&
        !given.is(net::Layer::subsystem, PlaceRole::output))
      acts_[given.subsystem.value] = true;
    // It has not ended if it has never begun: its agent is still to start it.
    system_not_begun = system_not_begun || given.is(net::Layer::system, PlaceRole::input);
    if (given.is(net::Layer::agent, PlaceRole::input)) not_begun.insert(given.agent);
  }
  for (std::uint32_t index = 0; index < acts_.size(); ++index)
    if (system_not_begun || not_begun.contains(net_.parts()[net::SubsystemId{index}].agent))
      acts_[index] = true;
}

bool Waits::moves(net::SubsystemId subsystem) const {
  return std::ranges::any_of(transitions_[subsystem.value],
                             [&](TransitionId id) { return net::enabled(net_, id, tokens_); });
}

std::set<std::uint32_t> Waits::lacking(net::SubsystemId subsystem) const {
  return verify::lacking(net_, tokens_, transitions_[subsystem.value]);
}

std::vector<SubsystemAtEnd> Waits::waits_of(net::SubsystemId subsystem) const {
  std::vector<SubsystemAtEnd> all;
  const std::set<std::uint32_t> lacks = lacking(subsystem);
  const bool all_own =
      std::ranges::all_of(lacks, [&](std::uint32_t place) { return is_own_memory(subsystem, place); });
  for (const std::uint32_t place : lacks) {
    // A token that only it can give belongs to another branch than the one that waits for other subsystems.
    if (!all_own && is_own_memory(subsystem, place)) continue;
    if (SubsystemAtEnd one = wait_at(subsystem, place); std::ranges::count(all, one) == 0)
      all.push_back(std::move(one));
  }
  for (std::uint32_t place = 0; place < tokens_.size(); ++place)
    if (tokens_[place] > 0 && net_.places()[place].subsystem == subsystem &&
        net_.places()[place].role == PlaceRole::no_successor)
      all.push_back({.state = SubsystemAtEnd::State::no_successor,
                     .path = name(subsystem),
                     .behaviour = behaviour_left(place),
                     .text = name(subsystem) + " left " + behaviour_left(place) +
                             ", and none of its initial conditions held"});
  return all;
}

std::string Waits::behaviour_left(std::uint32_t place) const {
  const net::Place& at = net_.places()[place];
  const std::vector<std::string>& behaviours = net_.parts()[at.subsystem].behaviours;
  return at.behaviour.value < behaviours.size() ? behaviours[at.behaviour.value] : std::string();
}

SubsystemAtEnd Waits::ended(net::SubsystemId subsystem) const {
  return {
      .state = SubsystemAtEnd::State::ended, .path = name(subsystem), .text = name(subsystem) + " has ended"};
}

SubsystemAtEnd Waits::wait_at(net::SubsystemId subsystem, std::uint32_t missing) const {
  const net::Place& place = net_.places()[missing];
  const Good good = good_of(place);
  std::string what = " waits for the memory of ";
  if (good == Good::value) what = " waits for a value of ";
  if (good == Good::acknowledgement) what = " waits for the acknowledgement of ";
  SubsystemAtEnd wait{.state = SubsystemAtEnd::State::waits,
                      .awaited = good,
                      .path = name(subsystem),
                      .channel = channel(place)};
  std::string from;
  for (const net::SubsystemId giver : givers(missing, subsystem)) {
    from += (from.empty() ? " from " : " or ") + (giver == subsystem ? "itself" : name(giver));
    wait.from.push_back(name(giver));
  }
  wait.text = name(subsystem) + what + channel(place) + (from.empty() ? ", which nobody gives" : from) +
              cut_at(place);
  return wait;
}

std::set<net::SubsystemId> Waits::givers(std::uint32_t place, net::SubsystemId waiting) const {
  std::set<net::SubsystemId> all;
  if (const auto found = giving_.find(net_.places()[place].channel); found != giving_.end())
    for (const TransitionId id : found->second)
      if (gives(id, place)) all.insert(net_[id].subsystem);
  if (all.size() > 1) all.erase(waiting);
  return all;
}

std::vector<TransitionId> Waits::giving(net::SubsystemId subsystem, std::uint32_t place) const {
  std::vector<TransitionId> all;
  for (const TransitionId id : transitions_[subsystem.value])
    if (gives(id, place)) all.push_back(id);
  return all;
}

bool Waits::gives(TransitionId id, std::uint32_t place) const {
  const auto here = [&](const net::Arc& arc) { return is_given(place, arc); };
  return std::ranges::any_of(net_.postset(id), here) && std::ranges::none_of(net_.preset(id), here);
}

bool Waits::is_own_memory(net::SubsystemId subsystem, std::uint32_t place) const {
  return good_of(net_.places()[place]) == Good::memory && givers(place, subsystem) == std::set{subsystem};
}

SubsystemAtEnd Waits::takes_no_more(net::SubsystemId reader, std::uint32_t place) const {
  const std::string& from = channel(net_.places()[place]);
  return {.state = SubsystemAtEnd::State::takes_no_more,
          .awaited = good_of(net_.places()[place]),
          .path = name(reader),
          .channel = from,
          .text = name(reader) + " goes on and receives " + from + " no more"};
}

SubsystemAtEnd Waits::gives_no_more(net::SubsystemId giver, std::uint32_t place) const {
  const Good good = good_of(net_.places()[place]);
  std::string does = " goes on and gives the memory of ";
  if (good == Good::value) does = " goes on and sends ";
  if (good == Good::acknowledgement) does = " goes on and acknowledges ";
  return {.state = SubsystemAtEnd::State::gives_no_more,
          .awaited = good,
          .path = name(giver),
          .channel = channel(net_.places()[place]),
          .text = name(giver) + does + channel(net_.places()[place]) + " no more"};
}

std::set<std::uint32_t> lacking(const net::Net& net, const std::vector<std::uint32_t>& tokens,
                                const std::vector<TransitionId>& transitions) {
  const auto has = [&](const net::Arc& arc) { return net::suffices(tokens, arc); };
  std::set<std::uint32_t> places;
  for (const TransitionId id : transitions) {
    // A wait with a timeout is described by what it waits for, not by what the timeout takes back.
    if (net[id].condition.kind == net::Condition::Kind::elapsed) continue;
    const auto inputs = net.preset(id);
    const auto of_channel = [&](const net::Arc& arc) { return has(arc) || net[arc.place].fused(); };
    if (!std::ranges::all_of(inputs, of_channel)) continue;
    for (const net::Arc& arc : inputs)
      if (!has(arc)) places.insert(arc.place.value);
  }
  return places;
}

}  // namespace tessera::verify
