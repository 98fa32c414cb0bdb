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

/// The possible endings of the behaviour that is left from a place.
std::map<PlaceId, std::vector<TransitionId>> endings_into(const net::Net& net) {
  std::map<PlaceId, std::vector<TransitionId>> found;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    const Condition& condition = net[id].condition;
    if (is_ending(condition) && condition.truth != Condition::Truth::never && net.postset(id).size() == 1)
      found[net.postset(id).front().place].push_back(id);
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
    if (is_ending(fired.condition)) ended_at[net.postset(run[at]).front().place] = at;
    if (fired.condition.kind != Condition::Kind::next) continue;
    const PlaceId left = net.preset(run[at]).front().place;
    const auto ended = ended_at.find(left);
    const auto choices = endings.find(left);
    if (ended == ended_at.end() || choices == endings.end()) continue;
    if (fits(net[run[ended->second]].condition, fired.condition)) continue;
    for (const TransitionId other : choices->second)
      if (fits(net[other].condition, fired.condition)) run[ended->second] = other;
  }
  return run;
}

}  // namespace tessera::verify
