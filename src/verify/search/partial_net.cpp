#include "verify/search/partial_net.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <string>
#include <unordered_map>
#include <utility>

namespace tessera::verify {
namespace {

using explore::Formula;
using net::Arc;
using net::PlaceId;
using Places = std::vector<std::uint32_t>;  // sorted

constexpr std::size_t most_tokens = 2'000'000;  // in all markings of a part

void places_in(const Formula& formula, std::vector<std::uint32_t>& to) {
  if (formula.kind == Formula::Kind::at_least) to.push_back(formula.node);
  for (const Formula& part : formula.parts) places_in(part, to);
}

/// The marked places, one character each.
using Marking = std::u32string;

Marking marking_of(const Places& places) { return {places.begin(), places.end()}; }

bool marks(const Marking& marking, std::uint32_t place) {
  return std::binary_search(marking.begin(), marking.end(), static_cast<char32_t>(place));
}

/// nullopt: it cannot be fired, or two tokens would meet.
std::optional<Marking> fired(const Marking& before, const Places& in, const Places& out) {
  Marking rest;
  rest.reserve(before.size() + out.size());
  std::size_t taken = 0;
  for (const char32_t place : before)
    if (taken < in.size() && place == in[taken])
      ++taken;
    else
      rest.push_back(place);
  if (taken < in.size()) return std::nullopt;
  for (const std::uint32_t place : out) {
    const auto at = std::lower_bound(rest.begin(), rest.end(), static_cast<char32_t>(place));
    if (at != rest.end() && *at == place) return std::nullopt;
    rest.insert(at, static_cast<char32_t>(place));
  }
  return rest;
}

}  // namespace

std::optional<std::uint32_t> PartialNet::place_of(std::uint32_t place) const {
  const auto found = places_.find(place);
  return found == places_.end() ? std::nullopt : std::optional(found->second);
}

Places PartialNet::inside(std::span<const Arc> arcs, Step* step) {
  Places there;
  for (const Arc& arc : arcs) {
    if (!surroundings_.stays(arc.place, subsystems_)) {
      if (step != nullptr) step->needs.push_back(arc.place);
      continue;
    }
    PlaceId place = arc.place;
    if (merged_ != nullptr && merged_->is_merged(place)) {
      place = (*merged_)[place];
      if (step != nullptr) step->is_certain = false;
      if (!place.valid()) continue;
    }
    const auto [entry, added] = places_.try_emplace(place.value, static_cast<std::uint32_t>(places_.size()));
    there.push_back(entry->second);
    if (net_[arc.place].tokens > 0 || surroundings_.is_started(arc.place))
      filled_.emplace(arc.place.value, entry->second);
  }
  std::ranges::sort(there);
  return there;
}

PartialNet::PartialNet(const net::Net& net, const Surroundings& surroundings, const TokenSets& sets,
                       const Subsystems& subsystems, const MergedPlaces* merged)
    : net_(net), surroundings_(surroundings), sets_(sets), subsystems_(subsystems), merged_(merged) {
  add_steps();
  places_count_ = static_cast<std::uint32_t>(places_.size());
  add_starts();
  takers_.resize(places_count_);
  for (std::uint32_t step = 0; step < steps_.size(); ++step)
    for (const std::uint32_t place : steps_[step].in) takers_[place].push_back(step);
  find_lonely_steps();
}

void PartialNet::add_steps() {
  std::set<std::pair<Places, Places>> uncertain;  // the same step of many places that count as one
  for (const net::SubsystemId subsystem : subsystems_)
    for (const net::TransitionId id : surroundings_.transitions(subsystem)) {
      Step step{.id = id, .in = {}, .out = {}};
      step.in = inside(net_.preset(id), &step);
      step.out = inside(net_.postset(id), nullptr);
      if (step.in.empty() && step.out.empty()) continue;
      if (!step.is_certain && (step.in == step.out || !uncertain.emplace(step.in, step.out).second)) continue;
      steps_.push_back(std::move(step));
    }
}

/// The layers above start each subsystem at some time, before which it has no token.
void PartialNet::add_starts() {
  for (const auto& [place, number] : filled_) {
    if (net_.places()[place].tokens > 0) initial_.push_back(number);
    if (!surroundings_.is_started({place})) continue;
    initial_.push_back(places_count_);
    steps_.push_back({.id = {}, .in = {places_count_++}, .out = {number}});
  }
  std::ranges::sort(initial_);
}

void PartialNet::find_lonely_steps() {
  std::set<std::uint32_t> shared;
  for (const auto& [place, number] : places_)
    if (net_.places()[place].fused() || net_.places()[place].fact.valid()) shared.insert(number);
  for (Step& step : steps_) {
    step.is_alone =
        step.needs.empty() && step.is_certain && !step.in.empty() &&
        std::ranges::all_of(step.in, [&](std::uint32_t place) { return takers_[place].size() == 1; }) &&
        std::ranges::none_of(step.out, [&](std::uint32_t place) { return shared.contains(place); });
  }
}

bool PartialNet::knows(const Formula& formula) const {
  std::vector<std::uint32_t> all;
  places_in(formula, all);
  return std::ranges::all_of(all, [&](std::uint32_t place) {
    return places_.contains(place) || surroundings_.stays({place}, subsystems_);
  });
}

/// The markings of a part that are reached.
class PartialGraph {
 public:
  PartialGraph(const PartialNet& part, const std::vector<const Formula*>& watched,
               const std::set<net::TransitionId>& goals, const explore::Budget& budget)
      : part_(part), goals_(goals), budget_(budget) {
    for (const Formula* formula : watched) {
      std::vector<std::uint32_t> all;
      places_in(*formula, all);
      for (const std::uint32_t place : all)
        if (const auto here = part.place_of(place)) seen_.insert(*here);
    }
    explore();
  }

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// It has more markings than are searched.
  [[nodiscard]] bool is_too_large() const { return is_too_large_; }

  [[nodiscard]] bool holds(const Formula& formula, std::size_t node) const {
    switch (formula.kind) {
      case Formula::Kind::at_least: {
        const auto place = part_.place_of(formula.node);
        return place ? marks(*nodes_[node], *place) : part_.surroundings_.tokens({formula.node}) > 0;
      }
      case Formula::Kind::negation:
        return !holds(formula.parts.front(), node);
      case Formula::Kind::all:
        return std::ranges::all_of(formula.parts, [&](const Formula& one) { return holds(one, node); });
      case Formula::Kind::any:
        return std::ranges::any_of(formula.parts, [&](const Formula& one) { return holds(one, node); });
      case Formula::Kind::enabled:
      case Formula::Kind::dead:
        break;
    }
    return false;
  }

  /// All that follow these before a goal.
  [[nodiscard]] std::vector<bool> followers(std::vector<bool> from, const std::vector<bool>& goal) const {
    std::deque<std::size_t> open;
    for (std::size_t node = 0; node < size(); ++node)
      if (from[node] && !goal[node]) open.push_back(node);
    while (!open.empty()) {
      const std::size_t node = open.front();
      open.pop_front();
      for (const Edge& edge : edges_[node]) {
        if (from[edge.to] || goal[edge.to]) continue;
        from[edge.to] = true;
        open.push_back(edge.to);
      }
    }
    return from;
  }

  /// The markings that reach one of the goals, or fire one of the goals' transitions, for certain.
  [[nodiscard]] std::vector<bool> certain(std::vector<bool> goal) const {
    std::vector<std::vector<std::uint32_t>> before(size());
    for (std::uint32_t node = 0; node < size(); ++node)
      for (const Edge& edge : edges_[node]) before[edge.to].push_back(node);
    std::deque<std::uint32_t> open;
    for (std::uint32_t node = 0; node < size(); ++node) {
      if (!goal[node] && can_go(node, goal)) goal[node] = true;
      if (goal[node]) open.push_back(node);
    }
    while (!open.empty()) {
      const std::uint32_t node = open.front();
      open.pop_front();
      for (const std::uint32_t one : before[node]) {
        if (goal[one] || !can_go(one, goal)) continue;
        goal[one] = true;
        open.push_back(one);
      }
    }
    return goal;
  }

  /// The owners of channels that decide what the markings can do.
  [[nodiscard]] PartialNet::Subsystems peers_of(const std::vector<bool>& markings) const {
    PartialNet::Subsystems peers;
    for (std::size_t node = 0; node < size(); ++node) {
      if (!markings[node]) continue;
      for (const Edge& edge : edges_[node])
        if (const PartialNet::Step& step = part_.steps_[edge.step]; step.is_certain)
          for (const PlaceId place : step.needs)
            for (const net::SubsystemId user : part_.surroundings_.users(place))
              if (user.valid() && !part_.subsystems_.contains(user)) peers.insert(user);
    }
    return peers;
  }

 private:
  struct Edge {
    std::uint32_t to, step;
  };

  [[nodiscard]] bool is_seen(const PartialNet::Step& step) const {
    const auto seen = [&](std::uint32_t place) { return seen_.contains(place); };
    return goals_.contains(step.id) || std::ranges::any_of(step.in, seen) ||
           std::ranges::any_of(step.out, seen);
  }

  std::uint32_t add(Marking marking) {
    const auto [entry, added] =
        numbers_.try_emplace(std::move(marking), static_cast<std::uint32_t>(nodes_.size()));
    if (added) {
      nodes_.push_back(&entry->first);
      tokens_ += entry->first.size();
      edges_.emplace_back();
    }
    return entry->second;
  }

  /// The marking after steps that can be fired whatever comes first, and that nobody sees.
  [[nodiscard]] Marking after_lonely_steps(Marking marking) const {
    constexpr int most = 1000;  // they may go round for ever
    for (int count = 0; count < most; ++count) {
      const auto lonely = [&]() -> std::optional<Marking> {
        for (const char32_t place : marking) {
          const std::vector<std::uint32_t>& takers = part_.takers_[place];
          if (takers.size() != 1 || !part_.steps_[takers.front()].is_alone) continue;
          const PartialNet::Step& step = part_.steps_[takers.front()];
          if (step.in.front() != place || is_seen(step)) continue;
          if (std::optional<Marking> next = fired(marking, step.in, step.out)) return next;
        }
        return std::nullopt;
      };
      std::optional<Marking> next = lonely();
      if (!next) break;
      marking = std::move(*next);
    }
    return marking;
  }

  void explore() {
    add(after_lonely_steps(marking_of(part_.initial_)));
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      if (node % 256 == 0) budget_.check();
      is_too_large_ = tokens_ > most_tokens;
      if (is_too_large_) return;
      const Marking& marking = *nodes_[node];
      for (const char32_t place : marking)
        for (const std::uint32_t step : part_.takers_[place])
          if (part_.steps_[step].in.front() == place) go(node, step);
      for (std::uint32_t step = 0; step < part_.steps_.size(); ++step)
        if (part_.steps_[step].in.empty()) go(node, step);
    }
  }

  void go(std::size_t node, std::uint32_t step) {
    std::optional<Marking> next = fired(*nodes_[node], part_.steps_[step].in, part_.steps_[step].out);
    if (!next) return;
    const std::uint32_t to = add(after_lonely_steps(std::move(*next)));
    edges_[node].push_back({to, step});
  }

  [[nodiscard]] bool leads(const Edge& edge, const std::vector<bool>& goal) const {
    const PartialNet::Step& step = part_.steps_[edge.step];
    return step.is_certain && (goal[edge.to] || goals_.contains(step.id));
  }

  /// Whether there is a step towards the goal wherever the token of the set is.
  [[nodiscard]] bool is_covered(std::uint32_t node, std::size_t set, const std::vector<bool>& goal) const {
    return std::ranges::all_of(part_.sets_[set], [&](PlaceId place) {
      const auto here = part_.place_of(place.value);
      return here ? !marks(*nodes_[node], *here) : is_covered_at(node, set, place, goal, 0);
    });
  }
  [[nodiscard]] bool is_covered_at(std::uint32_t node, std::size_t set, PlaceId place,
                                   const std::vector<bool>& goal, int moves) const {
    constexpr int most_moves = 4;
    const auto goes = [&](const Edge& edge) {
      const std::vector<PlaceId>& needs = part_.steps_[edge.step].needs;
      return needs.size() == 1 && needs.front() == place && leads(edge, goal);
    };
    if (std::ranges::any_of(edges_[node], goes)) return true;
    return moves < most_moves && std::ranges::any_of(part_.sets_.next(place), [&](PlaceId next) {
             return std::ranges::count(part_.sets_[set], next) > 0 && !part_.place_of(next.value) &&
                    is_covered_at(node, set, next, goal, moves + 1);
           });
  }

  /// Whether there is a step towards the goal, whatever the places hold that are left out.
  [[nodiscard]] bool can_go(std::uint32_t node, const std::vector<bool>& goal) const {
    const std::vector<Edge>& edges = edges_[node];
    for (const Edge& edge : edges) {
      if (!leads(edge, goal)) continue;
      const std::vector<PlaceId>& needs = part_.steps_[edge.step].needs;
      if (needs.empty()) return true;
      if (needs.size() > 1) continue;
      const std::vector<std::size_t>& sets = part_.sets_.with(needs.front());
      if (std::ranges::any_of(sets, [&](std::size_t set) { return is_covered(node, set, goal); }))
        return true;
    }
    return false;
  }

  const PartialNet& part_;
  const std::set<net::TransitionId>& goals_;
  const explore::Budget& budget_;
  std::size_t tokens_ = 0;
  bool is_too_large_ = false;
  std::set<std::uint32_t> seen_;
  std::unordered_map<Marking, std::uint32_t> numbers_;
  std::vector<const Marking*> nodes_;
  std::vector<std::vector<Edge>> edges_;
};

PartialNet::Result PartialNet::never(const Formula& bad, const explore::Budget& budget) const {
  const std::set<net::TransitionId> none;
  const PartialGraph graph(*this, {&bad}, none, budget);
  Result result{.holds = !graph.is_too_large(), .peers = {}, .markings = graph.size()};
  if (graph.is_too_large()) return result;
  for (std::size_t node = 0; node < graph.size() && result.holds; ++node)
    result.holds = !graph.holds(bad, node);
  if (!result.holds)
    for (const auto& peer : graph.peers_of(std::vector<bool>(graph.size(), true))) result.peers.insert(peer);
  return result;
}

PartialNet::Result PartialNet::reaches(const Formula& from, const Goal& goal,
                                       const explore::Budget& budget) const {
  const PartialGraph graph(*this, {&from, &goal.formula}, goal.fired, budget);
  Result result{.holds = !graph.is_too_large(), .peers = {}, .markings = graph.size()};
  if (graph.is_too_large()) return result;
  std::vector<bool> begin(graph.size()), there(graph.size());
  for (std::size_t node = 0; node < graph.size(); ++node) {
    begin[node] = graph.holds(from, node);
    there[node] = graph.holds(goal.formula, node);
  }
  const std::vector<bool> asked = graph.followers(begin, there);
  const std::vector<bool> certain = graph.certain(there);
  std::vector<bool> lost(graph.size());
  for (std::size_t node = 0; node < graph.size(); ++node) {
    lost[node] = asked[node] && !certain[node];
    if (lost[node]) result.holds = false;
  }
  if (!result.holds) result.peers = graph.peers_of(lost);
  return result;
}

}  // namespace tessera::verify
