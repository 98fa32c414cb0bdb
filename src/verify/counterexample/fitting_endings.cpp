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

/// The way in which a behaviour or a group is left.
enum class Way { terminal, error };

bool fits(Way way, const Condition& next) {
  return way == Way::terminal ? next.follows.terminal : next.follows.error;
}

bool same_arcs(const net::Net& net, TransitionId a, TransitionId b) {
  const auto places = [](auto arcs) {
    std::vector<PlaceId> all;
    for (const net::Arc& arc : arcs) all.push_back(arc.place);
    std::ranges::sort(all);
    return all;
  };
  return places(net.preset(a)) == places(net.preset(b)) && places(net.postset(a)) == places(net.postset(b));
}

/// A run whose behaviours and groups are left in ways that their entries of `next` can follow.
class Fitting {
 public:
  Fitting(const net::Net& net, std::vector<TransitionId>& run)
      : net_(net), run_(run), endings_(endings_into(net)) {
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      if (net.transitions()[index].condition.kind == Condition::Kind::next)
        entries_[place_left(TransitionId{index})].push_back({index});
  }

  void fit() {
    for (std::size_t at = 0; at < run_.size(); ++at) {
      const Condition::Kind kind = net_[run_[at]].condition.kind;
      if (kind == Condition::Kind::next) follow(at);
      if (kind == Condition::Kind::next || is_ending(net_[run_[at]].condition)) arrive(at);
    }
  }

 private:
  void arrive(std::size_t at) {
    if (const PlaceId place = place_after(net_, run_[at]); place.valid()) arrived_[place] = at;
  }

  [[nodiscard]] PlaceId place_left(TransitionId entry) const {
    PlaceId left;
    for (const net::Arc& arc : net_.preset(entry))
      if (!net_[arc.place].fact.valid()) left = arc.place;
    return left;
  }

  /// The number of the last transition into the place that an entry leaves, if that was an ending or an entry.
  [[nodiscard]] std::optional<std::size_t> arrival_before(std::size_t entry) const {
    if (const auto known = left_at_.find(entry); known != left_at_.end()) return known->second;
    return std::nullopt;
  }

  /// An entry that leaves a group is taken after one kind of ending, or after both: then the ending decides.
  [[nodiscard]] std::optional<Way> way_of(std::size_t at) const {
    const Condition& condition = net_[run_[at]].condition;
    if (condition.kind == Condition::Kind::terminal) return Way::terminal;
    if (condition.kind == Condition::Kind::error) return Way::error;
    if (condition.follows.terminal != condition.follows.error)
      return condition.follows.error ? Way::error : Way::terminal;
    const auto before = arrival_before(at);
    return before ? way_of(*before) : std::nullopt;
  }

  /// Lets the place that transition `at` of the run leads to be reached in that way, if another with the same arcs
  /// can do so.
  bool change(std::size_t at, Way wanted) {
    if (way_of(at) == wanted) return true;
    const net::Transition& fired = net_[run_[at]];
    if (is_ending(fired.condition)) {
      const auto choices = endings_.find(place_after(net_, run_[at]));
      if (choices == endings_.end()) return false;
      for (const TransitionId other : choices->second)
        if ((net_[other].condition.kind == Condition::Kind::terminal) == (wanted == Way::terminal) &&
            facts_of(net_, other) == facts_of(net_, run_[at])) {
          run_[at] = other;
          return true;
        }
      return false;
    }
    const auto before = arrival_before(at);
    if (!before) return false;
    for (const TransitionId other : entries_[place_left(run_[at])])
      if (same_arcs(net_, other, run_[at]) && fits(wanted, net_[other].condition) &&
          change(*before, wanted)) {
        run_[at] = other;
        return true;
      }
    return false;
  }

  void follow(std::size_t at) {
    const auto arrived = arrived_.find(place_left(run_[at]));
    if (arrived == arrived_.end()) return;
    left_at_[at] = arrived->second;
    const std::optional<Way> way = way_of(arrived->second);
    const Condition& taken = net_[run_[at]].condition;
    if (!way || fits(*way, taken)) return;
    if (change(arrived->second, *way == Way::terminal ? Way::error : Way::terminal)) return;
    for (const TransitionId other : entries_[place_left(run_[at])])
      if (same_arcs(net_, other, run_[at]) && fits(*way, net_[other].condition)) run_[at] = other;
  }

  const net::Net& net_;
  std::vector<TransitionId>& run_;
  std::map<PlaceId, std::vector<TransitionId>> endings_,
      entries_;                                 // by the place that they lead to, or leave
  std::map<PlaceId, std::size_t> arrived_;      // the last transition into a place
  std::map<std::size_t, std::size_t> left_at_;  // per entry of the run, that before it
};

}  // namespace

std::vector<TransitionId> with_fitting_endings(const net::Net& net, std::vector<TransitionId> run) {
  Fitting(net, run).fit();
  return run;
}

}  // namespace tessera::verify
