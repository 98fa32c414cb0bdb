#include "verify/counterexample/explanation.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "net/token_game.hpp"
#include "verify/counterexample/aftermath.hpp"
#include "verify/counterexample/causes.hpp"
#include "verify/counterexample/waits.hpp"
#include "verify/search/claims.hpp"
#include "verify/search/goals.hpp"

namespace tessera::verify {
namespace {

using net::TransitionId;
using Run = std::vector<TransitionId>;
using Number = Aftermath::Number;

/// Markings rather than time: the same run on every machine.
constexpr std::size_t most_markings = 20'000;

Aftermath::Markings opposite(Aftermath::Markings markings) {
  markings.flip();
  return markings;
}

void add_new(std::vector<SubsystemAtEnd>& to, std::vector<SubsystemAtEnd> more) {
  for (SubsystemAtEnd& one : more)
    if (std::ranges::count(to, one) == 0) to.push_back(std::move(one));
}

/// Follows the waits, with all that can happen at hand.
class Explainer {
 public:
  Explainer(const net::Net& net, const Aftermath& after, Run run, std::vector<TransitionId> stuck,
            const explore::Budget& budget)
      : net_(net), after_(after), run_(std::move(run)), stuck_(std::move(stuck)), budget_(budget) {}

  /// false: the transitions do not get stuck.
  bool find_end() {
    const net::SubsystemId owner = net_[stuck_.front()].subsystem;
    // A subsystem that can still end is not stuck. A channel whose reader can still end is not dry.
    std::vector<TransitionId> any_of = stuck_;
    std::ranges::copy(last_of(owner), std::back_inserter(any_of));
    if (!go_to(opposite(after_.can_fire(any_of)))) return false;
    concern(owner);
    follow_all();
    return true;
  }

  /// Goes on until the peers of subsystems that are stuck for ever already are settled.
  void settle(const std::set<net::SubsystemId>& stopped) {
    const Waits waits = here();
    for (const net::SubsystemId subsystem : stopped)
      if (stuck_for_ever(waits, subsystem)) concern(subsystem);
    follow_all();
  }

  [[nodiscard]] Explanation result() && {
    const Waits waits = here();
    Explanation explanation{std::move(run_), {}};
    std::vector<std::set<std::uint32_t>> lacks;
    for (const net::SubsystemId subsystem : concerned_) lacks.push_back(waits_at(waits, subsystem));
    for (const net::SubsystemId subsystem : concerned_)
      add_new(explanation.waits, at_end(waits, subsystem, lacks));
    if (explanation.waits.empty() && !stuck_.empty()) explanation.waits = taken_no_more(waits);
    return explanation;
  }

 private:
  /// The transitions by which a subsystem ends.
  [[nodiscard]] std::vector<TransitionId> last_of(net::SubsystemId subsystem) const {
    const Waits waits = here();
    std::vector<TransitionId> last;
    for (const TransitionId id : waits.transitions(subsystem))
      for (const net::Arc& arc : net_.postset(id))
        if (net_[arc.place].is(net::Layer::subsystem, PlaceRole::output)) last.push_back(id);
    return last;
  }

  [[nodiscard]] Waits here() const { return {net_, after_.tokens(at_)}; }

  bool go_to(const Aftermath::Markings& goal) {
    const std::optional<Aftermath::Way> way = after_.way(at_, goal);
    if (!way) return false;
    run_.insert(run_.end(), way->run.begin(), way->run.end());
    at_ = way->to;
    return true;
  }

  void concern(net::SubsystemId subsystem) {
    if (std::ranges::count(concerned_, subsystem) == 0) concerned_.push_back(subsystem);
  }

  [[nodiscard]] bool stuck_for_ever(const Waits& waits, net::SubsystemId subsystem) const {
    return !after_.can_fire(waits.transitions(subsystem))[at_];
  }

  void follow_all() {
    // When one subsystem has been brought to its end, another one may have stopped too.
    for (Number before = at_ + 1; before != at_;) {
      before = at_;
      for (std::size_t next = 0; next < concerned_.size(); ++next) follow(concerned_[next]);
    }
  }

  /// Brings a subsystem that cannot go on for ever to its stop, and adds the subsystems that it waits for.
  void follow(net::SubsystemId subsystem) {
    budget_.check();
    const std::vector<TransitionId> transitions = here().transitions(subsystem);
    const Aftermath::Markings stops = opposite(after_.can_fire(transitions));
    if (!stops[at_]) {
      const Aftermath::Markings goes_on = opposite(after_.can_reach(stops));
      if (!after_.way(at_, goes_on)) static_cast<void>(go_to(stops));
    }
    const Waits waits = here();
    for (const std::uint32_t place : waits_at(waits, subsystem))
      for (const net::SubsystemId giver : waits.givers(place, subsystem)) concern(giver);
  }

  /// The places of channels that it lacks, stuck as a whole or, though it goes on, with the
  /// transitions asked for.
  [[nodiscard]] std::set<std::uint32_t> waits_at(const Waits& waits, net::SubsystemId subsystem) const {
    if (waits.has_ended(subsystem)) return {};
    if (stuck_for_ever(waits, subsystem)) return waits.lacking(subsystem);
    if (subsystem != concerned_.front()) return {};
    std::set<std::uint32_t> places;
    const Aftermath::Markings later = after_.reachable_from(at_);
    for (Number marking = 0; marking < after_.size(); ++marking) {
      if (!later[marking]) continue;
      budget_.check();
      places.merge(lacking(net_, after_.tokens(marking), stuck_));
    }
    return places;
  }

  /// lacks: of each that is concerned.
  [[nodiscard]] std::vector<SubsystemAtEnd> at_end(const Waits& waits, net::SubsystemId subsystem,
                                                   const std::vector<std::set<std::uint32_t>>& lacks) const {
    budget_.check();
    if (waits.has_ended(subsystem)) return {waits.ended(subsystem)};
    if (stuck_for_ever(waits, subsystem)) return waits.waits_of(subsystem);
    std::vector<SubsystemAtEnd> all;
    for (std::size_t other = 0; other < lacks.size(); ++other)
      for (const std::uint32_t place : lacks[other])
        if (waits.givers(place, concerned_[other]).contains(subsystem) &&
            !after_.can_fire(waits.giving(subsystem, place))[at_])
          add_new(all, {waits.gives_no_more(subsystem, place)});
    return all;
  }

  /// About a subsystem that goes on: no other subsystem can give what it lacks, or what is given
  /// is taken elsewhere.
  [[nodiscard]] std::vector<SubsystemAtEnd> taken_no_more(const Waits& waits) const {
    std::vector<SubsystemAtEnd> all;
    const net::SubsystemId subsystem = concerned_.front();
    if (waits.has_ended(subsystem) || stuck_for_ever(waits, subsystem)) return all;
    for (const net::Arc& arc : net_.preset(stuck_.front()))
      if (net_[arc.place].fused()) add_new(all, {waits.takes_no_more(subsystem, arc.place.value)});
    return all;
  }

  const net::Net& net_;
  const Aftermath& after_;
  Run run_;
  std::vector<TransitionId> stuck_;
  const explore::Budget& budget_;
  Number at_ = Aftermath::start;
  std::vector<net::SubsystemId> concerned_;
};

// ---------------------------------------------------------------------------------------------- large nets

net::Net starting_after(const net::Net& net, const Run& run) {
  const net::Marking tokens = net::marking_after(net, run);
  net::Net other(net.shared_parts());
  for (std::uint32_t index = 0; index < tokens.size(); ++index) {
    net::Place place = net.places()[index];
    place.tokens = tokens[index];
    other.add(std::move(place));
  }
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    other.add(net.transitions()[index], net.preset({index}), net.postset({index}));
  return other;
}

/// Gone on with until none of the transitions can be fired any more, by reductions and search.
Run to_the_end(const net::Net& net, Run run, const std::vector<TransitionId>& stuck,
               const explore::Budget& budget) {
  if (never_again(net, run, stuck)) return run;
  std::vector<explore::Formula> enabled;
  for (const TransitionId id : stuck) {
    std::vector<explore::Formula> marked;
    for (const net::Arc& arc : net.preset(id)) marked.push_back(explore::Formula::marked(arc.place));
    enabled.push_back(explore::Formula::all(std::move(marked)));
  }
  explore::Limits limits = budget.left();
  limits.markings = 5 * most_markings;
  limits.progress = nullptr;
  const Goal goal{explore::Formula::any(std::move(enabled))};
  const std::vector<Found> found = ask(starting_after(net, run), Ask::always_reachable, {goal},
                                       Found::Kind::no, {.safe = true, .rules = {}}, limits);
  if (found.front().kind == Found::Kind::unknown) budget.check();
  if (found.front().kind == Found::Kind::no)
    run.insert(run.end(), found.front().trace.begin(), found.front().trace.end());
  return run;
}

/// The transitions that can be shown never to fire again after a run.
class StuckForEver {
 public:
  StuckForEver(const net::Net& net, const Run& run) : possible_(possible_after(net, run)) {}
  [[nodiscard]] bool all(const std::vector<TransitionId>& transitions) const {
    return std::ranges::none_of(transitions, [&](TransitionId id) { return possible_[id.value]; });
  }

 private:
  std::vector<bool> possible_;  // per transition
};

/// The waits of subsystems that can be shown to be stuck, found by following the waits from the first one.
std::vector<SubsystemAtEnd> proved_waits(const net::Net& net, const Run& run,
                                         std::vector<net::SubsystemId> concerned,
                                         const explore::Budget& budget) {
  const Waits waits(net, net::marking_after(net, run));
  const StuckForEver stuck(net, run);
  std::vector<SubsystemAtEnd> all;
  std::set<net::SubsystemId> known(concerned.begin(), concerned.end());
  for (std::size_t next = 0; next < concerned.size(); ++next) {
    budget.check();
    const net::SubsystemId subsystem = concerned[next];
    if (waits.has_ended(subsystem)) {
      add_new(all, {waits.ended(subsystem)});
      continue;
    }
    if (waits.moves(subsystem) || !stuck.all(waits.transitions(subsystem))) continue;
    add_new(all, waits.waits_of(subsystem));
    for (const std::uint32_t place : waits.lacking(subsystem))
      for (const net::SubsystemId giver : waits.givers(place, subsystem))
        if (known.insert(giver).second) concerned.push_back(giver);
  }
  return all;
}

Explanation roughly_explained(const net::Net& net, Run run, const std::vector<TransitionId>& stuck,
                              const explore::Budget& budget) {
  run = to_the_end(net, std::move(run), stuck, budget);
  Run further = until_all_concerned_wait(net, run, stuck, budget);
  if (never_again(net, further, stuck)) run = std::move(further);
  std::vector<SubsystemAtEnd> waits = proved_waits(net, run, {net[stuck.front()].subsystem}, budget);
  return {std::move(run), std::move(waits)};
}

}  // namespace

Explanation explained(const net::Net& net, Run run, const std::vector<TransitionId>& stuck,
                      const explore::Budget& budget) {
  if (stuck.empty()) return {std::move(run), {}};
  const auto after = Aftermath::of(net, run, {net[stuck.front()].subsystem}, most_markings, budget);
  if (!after) return roughly_explained(net, std::move(run), stuck, budget);
  Explainer explainer(net, *after, run, stuck, budget);
  if (!explainer.find_end()) return {std::move(run), {}};
  return std::move(explainer).result();
}

Explanation explained(const net::Net& net, Run run, const explore::Budget& budget) {
  const Waits waits(net, net::marking_after(net, run));
  std::set<net::SubsystemId> stopped;
  for (std::uint32_t index = 0; index < waits.subsystems(); ++index)
    if (!waits.has_ended({index}) && !waits.moves({index})) stopped.insert({index});
  if (stopped.empty()) return {std::move(run), {}};
  if (const auto after = Aftermath::of(net, run, stopped, most_markings, budget)) {
    Explainer explainer(net, *after, std::move(run), {}, budget);
    explainer.settle(stopped);
    return std::move(explainer).result();
  }
  const StuckForEver stuck(net, run);
  std::vector<SubsystemAtEnd> all;
  for (const net::SubsystemId subsystem : stopped) {
    budget.check();
    if (stuck.all(waits.transitions(subsystem))) add_new(all, waits.waits_of(subsystem));
  }
  return {std::move(run), std::move(all)};
}

}  // namespace tessera::verify
