#include "verify/counterexample/fitting_endings.hpp"

#include <algorithm>
#include <map>
#include <optional>

namespace tessera::verify {
namespace {

using net::Condition;
using net::PlaceId;
using net::TransitionId;

bool is_ending(const Condition& condition) {
  return condition.kind == Condition::Kind::terminal || condition.kind == Condition::Kind::error;
}

/// The places of facts that a transition reads, in order.
std::vector<PlaceId> facts_of(const net::Net& net, TransitionId id) {
  std::vector<PlaceId> facts;
  for (const net::Arc& arc : net.preset(id))
    if (net[arc.place].fact.valid()) facts.push_back(arc.place);
  std::ranges::sort(facts);
  return facts;
}

/// The place that it gives a token to, besides those of facts, which it gives back; none: there are several.
PlaceId place_after(const net::Net& net, TransitionId id) {
  PlaceId after;
  for (const net::Arc& arc : net.postset(id)) {
    if (net[arc.place].fact.valid()) continue;
    if (after.valid()) return {};
    after = arc.place;
  }
  return after;
}

/// The possible endings of the behaviour that is left from a place.
std::map<PlaceId, std::vector<TransitionId>> endings_into(const net::Net& net) {
  std::map<PlaceId, std::vector<TransitionId>> found;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    const Condition& condition = net[id].condition;
    if (is_ending(condition) && condition.truth != Condition::Truth::never && place_after(net, id).valid())
      found[place_after(net, id)].push_back(id);
  }
  return found;
}

bool fits(const Condition& ending, const Condition& next) {
  return ending.kind == Condition::Kind::terminal ? next.follows.terminal : next.follows.error;
}

}  // namespace

std::vector<TransitionId> with_fitting_endings(const net::Net& net, std::vector<TransitionId> run) {
  const std::map<PlaceId, std::vector<TransitionId>> endings = endings_into(net);
  std::map<PlaceId, std::size_t> ended_at;  // the last ending into a place, by its number in the run
  for (std::size_t at = 0; at < run.size(); ++at) {
    const net::Transition& fired = net[run[at]];
    if (is_ending(fired.condition)) ended_at[place_after(net, run[at])] = at;
    if (fired.condition.kind != Condition::Kind::next) continue;
    PlaceId left;
    for (const net::Arc& arc : net.preset(run[at]))
      if (!net[arc.place].fact.valid()) left = arc.place;
    const auto ended = ended_at.find(left);
    const auto choices = endings.find(left);
    if (ended == ended_at.end() || choices == endings.end()) continue;
    if (fits(net[run[ended->second]].condition, fired.condition)) continue;
    for (const TransitionId other : choices->second)
      if (fits(net[other].condition, fired.condition) &&
          facts_of(net, other) == facts_of(net, run[ended->second]))
        run[ended->second] = other;
  }
  return run;
}

}  // namespace tessera::verify
