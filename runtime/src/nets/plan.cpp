#include "nets/plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "nets/shared_channel.hpp"
#include "tessera/channel_limits.hpp"

namespace tessera {
namespace {

[[nodiscard]] Outcome outcome_of(Guard::Kind kind) {
  return kind == Guard::Kind::error      ? Outcome::error
         : kind == Guard::Kind::terminal ? Outcome::terminal
                                         : Outcome::go_on;
}

class Compilation {
 public:
  Compilation(const SubsystemNet& net, std::span<const std::span<const FusedPlace>> fused, std::string& error)
      : net_(net), fused_(fused), error_(error) {}

  std::optional<Plan> result() {
    error_.clear();
    plan_.ports.resize(net_.ports.size());
    check_ports();
    for (const Place& place : net_.places) add(place);
    for (const Transition& transition : net_.transitions) add(transition);
    check_facts();
    plan_.in = checked(net_.in, net_.places.size(), "place");
    plan_.out = checked(net_.out, net_.places.size(), "place");
    if (!error_.empty()) return std::nullopt;
    index_leaving();
    return std::move(plan_);
  }

 private:
  void fail(std::string text) {
    if (error_.empty()) error_ = std::move(text);
  }

  std::uint16_t checked(std::uint16_t number, std::size_t count, std::string_view what) {
    if (number < count) return number;
    fail(fmt::format("there is no {} {}", what, number));
    return 0;
  }

  void check_ports() {
    for (std::size_t port = 0; port < net_.ports.size(); ++port) {
      if (fused_[port].empty()) fail(fmt::format("port '{}' has no channel", net_.ports[port].name));
      if (fused_[port].size() > most_shared_places)
        fail(fmt::format("the channel of port '{}' has more than {} places", net_.ports[port].name,
                         most_shared_places));
    }
  }

  /// A place of a fact has no operation that takes time, and each transition that reads it has another input.
  void check_facts() {
    for (const Plan::TransitionEntry& transition : plan_.transitions) {
      const auto inputs = plan_.inputs(transition);
      if (std::ranges::all_of(inputs, [&](std::uint32_t place) { return plan_.places[place].fact; }))
        fail("a transition takes nothing but facts");
    }
  }

  void add(const Place& place) {
    if (place.tokens > 0) {
      if (place.does.kind != Does::Kind::know || place.tokens > 1)
        fail(fmt::format("'{}' has tokens at the start", place.name));
      plan_.known.push_back(static_cast<std::uint32_t>(plan_.places.size()));
    }
    Plan::PlaceEntry entry{.does = place.does.kind};
    switch (place.does.kind) {
      case Does::Kind::nothing:
      case Does::Kind::count:
        break;
      case Does::Kind::begin:
        plan_.receive_first = true;
        [[fallthrough]];
      case Does::Kind::call:
      case Does::Kind::decide:
      case Does::Kind::route:
        entry.subject = checked(place.does.subject, net_.behaviours.size(), "behaviour");
        break;
      case Does::Kind::write:
      case Does::Kind::read:
        entry.subject = checked(place.does.subject, net_.ports.size(), "port");
        if (place.does.slot == 0) fail(fmt::format("'{}': slots count from 1", place.name));
        entry.slot = static_cast<std::uint16_t>(place.does.slot - 1);
        break;
      case Does::Kind::ask:
        entry.subject = checked(place.does.subject, net_.ports.size(), "port");
        entry.slot = checked(place.does.slot, net_.behaviours.size(), "behaviour");
        break;
      case Does::Kind::know:
        entry.subject = checked(place.does.subject, net_.facts.size(), "fact");
        entry.slot = place.does.slot;
        entry.fact = true;
        break;
    }
    plan_.places.push_back(entry);
  }

  void add(const Transition& transition) {
    Plan::TransitionEntry entry;
    entry.index = static_cast<std::uint32_t>(plan_.transitions.size());
    entry.guard = {transition.guard.kind, transition.guard.entry};
    entry.inputs = static_cast<std::uint32_t>(plan_.arcs.size());
    for (const ArcEnd end : transition.inputs) add_end(transition, end, entry, entry.taken);
    entry.outputs = static_cast<std::uint32_t>(plan_.arcs.size());
    for (const ArcEnd end : transition.outputs) add_end(transition, end, entry, entry.produced);
    if (transition.guard.port != nobody)
      entry.port = {checked(transition.guard.port, net_.ports.size(), "port")};
    entry.end = static_cast<std::uint32_t>(plan_.arcs.size());
    if (entry.inputs == entry.outputs)
      fail(fmt::format("'{}' takes from no place of its subsystem", transition.name));
    if (!error_.empty()) return;
    // A subsystem knows what it learns by a firing before it evaluates the conditions behind it.
    std::stable_partition(plan_.arcs.begin() + entry.outputs, plan_.arcs.end(),
                          [&](std::uint32_t place) { return plan_.places[place].fact; });
    find_latch(transition, entry);
    entry.tells_of_timeout = entry.guard.kind == Guard::Kind::elapsed;
    if (entry.taken != 0) entry.need = need(transition, entry.port, entry.taken);
    if (entry.outputs - entry.inputs == 1) {
      entry.from = {plan_.arcs[entry.inputs]};
      if (entry.end - entry.outputs == 1) entry.to = {plan_.arcs[entry.outputs]};
    }
    plan_.transitions.push_back(entry);
  }

  void add_end(const Transition& transition, ArcEnd end, Plan::TransitionEntry& entry, std::uint16_t& bits) {
    if (!end.is_shared()) {
      plan_.arcs.push_back(checked(end.place(), net_.places.size(), "place"));
      return;
    }
    const Plan::PortId port{checked(end.port(), net_.ports.size(), "port")};
    if (!error_.empty()) return;
    if (entry.port.valid() && entry.port != port)
      fail(fmt::format("'{}' touches two channels", transition.name));
    entry.port = port;
    if (end.place() >= fused_[port.value].size())
      return fail(fmt::format("'{}': its channel has no place {}", transition.name, end.place()));
    bits = static_cast<std::uint16_t>(bits | 1U << end.place());
  }

  void find_latch(const Transition& transition, Plan::TransitionEntry& entry) {
    const bool routed = entry.guard.kind == Guard::Kind::next;
    const bool told = entry.guard.kind == Guard::Kind::told;
    const bool asked = entry.guard.kind == Guard::Kind::send || entry.guard.kind == Guard::Kind::skip;
    if (entry.guard.kind == Guard::Kind::none || entry.guard.kind == Guard::Kind::elapsed) {
      if (entry.guard.kind == Guard::Kind::elapsed && !entry.port.valid())
        fail(fmt::format("'{}' waits for the timeout of no channel", transition.name));
      return;
    }
    for (std::uint32_t arc = entry.inputs; arc < entry.outputs; ++arc) {
      const Does::Kind does = plan_.places[plan_.arcs[arc]].does;
      if (does == (routed  ? Does::Kind::route
                   : told  ? Does::Kind::read
                   : asked ? Does::Kind::ask
                           : Does::Kind::decide))
        entry.latch = {plan_.arcs[arc]};
    }
    if (told && entry.latch.valid()) plan_.places[entry.latch.value].tells = true;
    entry.decided = routed || told ? entry.guard.entry
                    : asked        ? static_cast<std::int32_t>(entry.guard.kind == Guard::Kind::send)
                                   : static_cast<std::int32_t>(outcome_of(entry.guard.kind));
    const bool asks_facts = std::any_of(plan_.arcs.begin() + entry.inputs, plan_.arcs.begin() + entry.outputs,
                                        [&](std::uint32_t place) { return plan_.places[place].fact; });
    if (entry.latch.valid() && entry.decided < 64 && !asks_facts)
      plan_.places[entry.latch.value].ways |= std::uint64_t{1} << entry.decided;
    if (!entry.latch.valid()) fail(fmt::format("no place decides the condition of '{}'", transition.name));
  }

  std::uint8_t need(const Transition& transition, Plan::PortId port, std::uint16_t taken) {
    std::vector<std::uint16_t>& needs = plan_.ports[port.value].needs;
    const auto found = std::find(needs.begin(), needs.end(), taken);
    if (found != needs.end()) return static_cast<std::uint8_t>(found - needs.begin());
    if (needs.size() == most_needs)
      fail(fmt::format("'{}': its port takes in more than {} different ways", transition.name, most_needs));
    needs.push_back(taken);
    return static_cast<std::uint8_t>(needs.size() - 1);
  }

  void index_leaving() {
    std::vector<std::vector<std::uint32_t>> leaving(plan_.places.size());
    const auto timed = [&](std::uint32_t t) {
      return plan_.transitions[t].guard.kind == Guard::Kind::elapsed;
    };
    for (std::uint32_t t = 0; t < plan_.transitions.size(); ++t)
      for (std::uint32_t place : plan_.inputs(plan_.transitions[t]))
        if (!plan_.places[place].fact) leaving[place].push_back(t);
    for (std::vector<std::uint32_t>& ways : leaving) {
      const auto first_timed =
          std::stable_partition(ways.begin(), ways.end(), [&](std::uint32_t t) { return !timed(t); });
      plan_.places[plan_.first_leaving.size()].timed = first_timed != ways.end();
      if (first_timed != ways.end())
        std::for_each(ways.begin(), first_timed, [&](std::uint32_t t) {
          plan_.transitions[t].tells_of_timeout = plan_.transitions[t].port.valid();
        });
      plan_.first_leaving.push_back(static_cast<std::uint32_t>(plan_.leaving.size()));
      plan_.leaving.insert(plan_.leaving.end(), ways.begin(), ways.end());
    }
    plan_.first_leaving.push_back(static_cast<std::uint32_t>(plan_.leaving.size()));
    for (std::uint32_t t : plan_.leaving) plan_.departures.push_back(plan_.transitions[t]);
    for (std::uint32_t place = 0; place < plan_.places.size(); ++place) {
      Plan::PlaceEntry& entry = plan_.places[place];
      entry.idle = entry.does == Does::Kind::nothing && !entry.timed && place != plan_.out;
      if (plan_.leaving_of(place).empty()) continue;
      entry.departure = plan_.departures.data() + plan_.first_leaving[place];
      plan_.departures[plan_.first_leaving[place + 1] - 1].last = true;
    }
    for (Plan::TransitionEntry& transition : plan_.departures)
      if (transition.to.valid()) transition.onward = plan_.places[transition.to.value].departure;
  }

  const SubsystemNet& net_;
  std::span<const std::span<const FusedPlace>> fused_;
  std::string& error_;
  Plan plan_;
};

}  // namespace

std::optional<Plan> compile(const SubsystemNet& net, std::span<const std::span<const FusedPlace>> fused,
                            std::string& error) {
  return Compilation(net, fused, error).result();
}

}  // namespace tessera
