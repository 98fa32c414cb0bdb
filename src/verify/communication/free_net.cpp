#include "verify/communication/free_net.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "net/token_game.hpp"
#include "verify/communication/abstraction.hpp"

namespace tessera::verify {
namespace {

using net::Arc;
using net::Condition;
using net::PlaceId;
using net::TransitionId;
using Arcs = std::vector<Arc>;
using Truth = Condition::Truth;

bool is_fact(const net::Net& net, const Arc& arc) { return net[arc.place].fact.valid(); }

Arcs without_facts(const net::Net& net, std::span<const Arc> arcs) {
  Arcs rest;
  for (const Arc& arc : arcs)
    if (!is_fact(net, arc)) rest.push_back(arc);
  return rest;
}

bool uses_facts(const net::Net& net, TransitionId id) {
  const auto fact = [&](const Arc& arc) { return is_fact(net, arc); };
  return std::ranges::any_of(net.preset(id), fact) || std::ranges::any_of(net.postset(id), fact);
}

/// Transitions that are one in the free net have this in common.
using Common = std::tuple<std::string, Condition::Kind, std::optional<std::uint32_t>, Step, std::uint32_t>;
Common common_of(const net::Net& net, TransitionId id) {
  std::string ends;
  std::vector<Arcs> sides{without_facts(net, net.preset(id))};
  // Each net has places of its own for the case that no initial condition holds.
  if (net[id].role != Step::no_successor) sides.push_back(without_facts(net, net.postset(id)));
  for (const Arcs& arcs : sides) {
    std::set<std::string> names;
    for (const Arc& arc : arcs) names.insert(net[arc.place].name);
    for (const std::string& name : names) ends += name + '\n';
    ends += '>';
  }
  const net::Transition& transition = net[id];
  return {std::move(ends), transition.condition.kind, transition.condition.entry, transition.role,
          transition.block.value};
}

Condition::After joined(Condition::After a, Condition::After b) {
  return {a.terminal || b.terminal, a.error || b.error};
}

/// The condition of transitions that become one.
Condition joined(const Condition& a, const Condition& b) {
  Condition both = a;
  const auto join = [](Condition::Known x, Condition::Known y) {
    const bool never = x.truth == Truth::never && y.truth == Truth::never;
    return Condition::Known{never ? Truth::never : Truth::free, x.exhaustive && y.exhaustive};
  };
  const Condition::Known certain = join(a.known(false), b.known(false));
  const Condition::Known failing = join(a.known(true), b.known(true));
  both.truth = certain.truth;
  both.exhaustive = certain.exhaustive;
  both.with_failures.reset();
  both.set_with_failures(failing);
  both.asked.clear();
  both.follows = joined(a.follows, b.follows);
  both.none_follows = joined(a.none_follows, b.none_follows);
  if (both.text.empty() || both.text == "never") both.text = b.text;
  return both;
}

/// Some entry of `next` holds for certain only if that is so with all values of the facts.
void join_completeness(std::vector<std::pair<net::Transition, std::pair<Arcs, Arcs>>>& rows,
                       const std::vector<std::size_t>& merged) {
  std::map<PlaceId, std::pair<bool, bool>> complete;  // per exit of a behaviour: without and with failures
  const auto of = [&](std::size_t row) -> Condition& { return rows[row].first.condition; };
  for (const std::size_t row : merged) {
    if (of(row).kind != Condition::Kind::next) continue;
    const auto [entry, added] = complete.emplace(rows[row].second.first.front().place, std::pair(true, true));
    entry->second.first = entry->second.first && of(row).exhaustive;
    entry->second.second = entry->second.second && of(row).known(true).exhaustive;
  }
  for (const std::size_t row : merged) {
    if (of(row).kind != Condition::Kind::next) continue;
    const auto [certain, failing] = complete.at(rows[row].second.first.front().place);
    const Truth truth_failing = of(row).known(true).truth;
    of(row).exhaustive = certain;
    of(row).with_failures.reset();
    of(row).set_with_failures({truth_failing, failing});
  }
}

}  // namespace

std::optional<FreeNet> free_net(const net::Net& net, const std::vector<net::Invariant>& invariants) {
  if (net.parts().facts.empty()) return std::nullopt;
  FreeNet free{net::Net(net.shared_parts()), {}};
  for (const net::Place& place : net.places())
    if (!place.fact.valid()) free.net.add(place);
  std::vector<std::pair<net::Transition, std::pair<Arcs, Arcs>>> rows;
  std::map<Common, std::size_t> row_of;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    if (uses_facts(net, id)) {
      const auto [row, added] = row_of.emplace(common_of(net, id), rows.size());
      if (!added) {
        Condition& condition = rows[row->second].first.condition;
        condition = joined(condition, net[id].condition);
        continue;
      }
    }
    rows.push_back({net[id], {without_facts(net, net.preset(id)), without_facts(net, net.postset(id))}});
    // Other values of the facts have no such transition.
    if (Condition& condition = rows.back().first.condition;
        uses_facts(net, id) && condition.kind != Condition::Kind::none)
      condition = joined(condition, condition);
  }
  std::vector<std::size_t> merged;
  for (const auto& [common, row] : row_of) merged.push_back(row);
  join_completeness(rows, merged);
  for (auto& [transition, arcs] : rows) free.net.add(std::move(transition), arcs.first, arcs.second);
  for (const net::Invariant& invariant : invariants)
    if (std::ranges::none_of(invariant.terms,
                             [&](const net::Invariant::Term& term) { return net[term.place].fact.valid(); }))
      free.invariants.push_back(invariant);
  return free;
}

bool asks_facts(const net::Net& net, const net::Property& property) {
  const auto asks = [&net](const auto& self, const net::Statement& statement) -> bool {
    return std::ranges::any_of(statement.places, [&](PlaceId place) { return net[place].fact.valid(); }) ||
           std::ranges::any_of(statement.parts, [&](const net::Statement& part) { return self(self, part); });
  };
  return std::ranges::any_of(property.claims, [&](const net::Claim& claim) {
    return asks(asks, claim.what) || asks(asks, claim.then);
  });
}

bool facts_decide_sends(const net::Net& net) {
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const Condition::Kind kind = net[TransitionId{index}].condition.kind;
    const bool decides = kind == Condition::Kind::send || kind == Condition::Kind::skip;
    if (decides && uses_facts(net, {index})) return true;
  }
  return false;
}

std::optional<std::vector<TransitionId>> lifted(const net::Net& free, const net::Net& net,
                                                const std::vector<TransitionId>& run) {
  std::map<Common, std::vector<TransitionId>> copies;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    if (possible(net, {index})) copies[common_of(net, {index})].push_back({index});
  net::Marking marking = net::initial_marking(net);
  std::vector<TransitionId> there;
  for (const TransitionId id : run) {
    const auto found = copies.find(common_of(free, id));
    if (found == copies.end()) return std::nullopt;
    const auto copy = std::ranges::find_if(found->second,
                                           [&](TransitionId one) { return net::enabled(net, one, marking); });
    if (copy == found->second.end()) return std::nullopt;
    net::fire(net, *copy, marking);
    there.push_back(*copy);
  }
  return there;
}

bool choices_change_nothing(const CommunicationStructure& structure, const net::Net& net) {
  std::set<std::uint32_t> knowing;
  for (const net::Parts::Fact& fact : net.parts().facts) knowing.insert(fact.subsystem.value);
  return std::ranges::all_of(structure.subsystems, [&](const SubsystemFlow& subsystem) {
    if (!knowing.contains(subsystem.id.value)) return true;
    return std::ranges::all_of(subsystem.behaviours, [&](const BehaviourFlow& behaviour) {
      return behaviour.stages == subsystem.behaviours.front().stages && !behaviour.ends &&
             (behaviour.complete || !behaviour.leaves);
    });
  });
}

}  // namespace tessera::verify
