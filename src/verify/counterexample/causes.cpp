#include "verify/counterexample/causes.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "net/token_game.hpp"
#include "verify/counterexample/waits.hpp"

namespace tessera::verify {
namespace {

using net::Arc;
using net::PlaceId;
using net::TransitionId;
using Run = std::vector<TransitionId>;

using FiringId = net::Id<struct FiringTag>;  ///< of a run; none: the token was there from the start

/// The earlier firings that each firing of a run needed.
class History {
 public:
  History(const net::Net& net, const Run& run) : causes_(run.size()), tokens_(net.places().size()) {
    for (std::uint32_t place = 0; place < tokens_.size(); ++place)
      tokens_[place].resize(net.places()[place].tokens);
    for (std::uint32_t firing = 0; firing < run.size(); ++firing) {
      for (const Arc& arc : net.preset(run[firing]))
        for (std::uint32_t token = 0; token < arc.weight; ++token) {
          std::vector<FiringId>& held = tokens_[arc.place.value];
          if (held.empty()) return;
          causes_[firing].push_back(held.front());
          held.erase(held.begin());
        }
      for (const Arc& arc : net.postset(run[firing]))
        tokens_[arc.place.value].insert(tokens_[arc.place.value].end(), arc.weight, {firing});
    }
    is_run_ = true;
  }

  [[nodiscard]] bool is_run() const { return is_run_; }

  /// The firings behind the tokens that the places hold in the end.
  [[nodiscard]] std::vector<bool> behind(const std::set<std::uint32_t>& places) const {
    std::vector<bool> needed(causes_.size(), false);
    const auto need = [&](FiringId firing) {
      if (firing.valid()) needed[firing.value] = true;
    };
    for (const std::uint32_t place : places) std::ranges::for_each(tokens_[place], need);
    for (std::size_t firing = causes_.size(); firing-- > 0;)
      if (needed[firing]) std::ranges::for_each(causes_[firing], need);
    return needed;
  }

 private:
  std::vector<std::vector<FiringId>> causes_;  // per firing: those whose tokens it took
  std::vector<std::vector<FiringId>> tokens_;  // per place, in the end: the firings they come from
  bool is_run_ = false;
};

/// The transitions that could fire after a run if firing consumed no tokens: at least all that can fire.
class Prospect {
 public:
  Prospect(const net::Net& net, const Run& run)
      : net_(net), reached_by_(net.places().size()), missing_(net.transitions().size()) {
    const net::Marking tokens = net::marking_after(net, run);
    std::vector<std::vector<std::uint32_t>> takers(net.places().size());
    for (std::uint32_t index = 0; index < missing_.size(); ++index) {
      missing_[index] = net.preset({index}).size();
      for (const Arc& arc : net.preset({index})) takers[arc.place.value].push_back(index);
      if (missing_[index] == 0) fire(index);
    }
    for (std::uint32_t place = 0; place < tokens.size(); ++place)
      if (tokens[place] > 0) reach(place, {});
    for (std::size_t next = 0; next < places_.size(); ++next)
      for (const std::uint32_t taker : takers[places_[next]])
        if (--missing_[taker] == 0) fire(taker);
  }

  [[nodiscard]] bool possible(TransitionId id) const {
    return missing_[id.value] == 0 && net_[id].condition.truth != net::Condition::Truth::never;
  }

  /// The transitions on the way to one that is possible, itself included.
  [[nodiscard]] std::set<std::uint32_t> way_to(TransitionId id) const {
    std::set<std::uint32_t> way{id.value};
    std::vector<std::uint32_t> open{id.value};
    while (!open.empty()) {
      const TransitionId last{open.back()};
      open.pop_back();
      for (const Arc& arc : net_.preset(last)) {
        const TransitionId from = reached_by_[arc.place.value].value();
        if (from.valid() && way.insert(from.value).second) open.push_back(from.value);
      }
    }
    return way;
  }

 private:
  void reach(std::uint32_t place, TransitionId by) {
    if (reached_by_[place]) return;
    reached_by_[place] = by;
    places_.push_back(place);
  }
  void fire(std::uint32_t transition) {
    if (net_.transitions()[transition].condition.truth == net::Condition::Truth::never) return;
    for (const Arc& arc : net_.postset({transition})) reach(arc.place.value, {transition});
  }

  const net::Net& net_;
  std::vector<std::optional<TransitionId>> reached_by_;  // per place; a transition of none: it was marked
  std::vector<std::size_t> missing_;                     // per transition: input places not reached
  std::vector<std::uint32_t> places_;                    // reached, in order
};

/// Places that have to be as they are for the transitions to stay out of reach.
class Concern {
 public:
  explicit Concern(const net::Net& net) : net_(net) {
    for (std::uint32_t place = 0; place < net.places().size(); ++place) {
      const net::SubsystemId subsystem = net.places()[place].subsystem;
      if (!subsystem.valid()) continue;
      if (subsystem.value >= of_subsystem_.size()) of_subsystem_.resize(subsystem.value + 1);
      of_subsystem_[subsystem.value].push_back(place);
    }
  }

  /// The places of the transition and of its subsystem. False: all of them were there.
  bool add(TransitionId id) {
    const std::size_t before = places_.size();
    for (const auto arcs : {net_.preset(id), net_.postset(id)})
      for (const Arc& arc : arcs) places_.insert(arc.place.value);
    if (const net::SubsystemId subsystem = net_[id].subsystem; subsystem.value < of_subsystem_.size())
      places_.insert(of_subsystem_[subsystem.value].begin(), of_subsystem_[subsystem.value].end());
    return places_.size() > before;
  }

  [[nodiscard]] const std::set<std::uint32_t>& places() const { return places_; }

 private:
  const net::Net& net_;
  std::vector<std::vector<std::uint32_t>> of_subsystem_;
  std::set<std::uint32_t> places_;
};

/// Those that give or take tokens which the stuck transitions lack where a token waits for them.
std::vector<TransitionId> awaited(const net::Net& net, const Run& run,
                                  const std::vector<TransitionId>& stuck) {
  const net::Marking tokens = net::marking_after(net, run);
  std::set<std::uint32_t> lacking;
  for (const TransitionId id : stuck) {
    const auto inputs = net.preset(id);
    if (std::ranges::none_of(inputs, [&](const Arc& arc) { return net::suffices(tokens, arc); })) continue;
    for (const Arc& arc : inputs)
      if (!net::suffices(tokens, arc) && net[arc.place].fused()) lacking.insert(arc.place.value);
  }
  std::vector<TransitionId> found;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    for (const auto arcs : {net.preset({index}), net.postset({index})})
      if (std::ranges::any_of(arcs, [&](const Arc& arc) { return lacking.contains(arc.place.value); }))
        found.push_back({index});
  return found;
}

}  // namespace

Run causes_of_standstill(const net::Net& net, Run run, const std::vector<TransitionId>& stuck,
                         const explore::Budget& budget) {
  const History history(net, run);
  if (!history.is_run()) return run;
  Concern concern(net);
  for (const TransitionId id : stuck) concern.add(id);
  for (const TransitionId id : awaited(net, run, stuck)) concern.add(id);
  while (true) {
    budget.check();
    const std::vector<bool> needed = history.behind(concern.places());
    Run kept;
    for (std::size_t firing = 0; firing < run.size(); ++firing)
      if (needed[firing]) kept.push_back(run[firing]);
    const Prospect prospect(net, kept);
    bool excluded = true, more = false;
    for (const TransitionId id : stuck) {
      if (!prospect.possible(id)) continue;
      excluded = false;
      for (const std::uint32_t transition : prospect.way_to(id)) more = concern.add({transition}) || more;
    }
    if (excluded) return kept;
    if (!more) return run;
  }
}

Run causes_of_tokens(const net::Net& net, Run run, const std::vector<PlaceId>& places) {
  const History history(net, run);
  if (!history.is_run()) return run;
  std::set<std::uint32_t> wanted;
  for (const PlaceId place : places) wanted.insert(place.value);
  const std::vector<bool> needed = history.behind(wanted);
  Run kept;
  for (std::size_t firing = 0; firing < run.size(); ++firing)
    if (needed[firing]) kept.push_back(run[firing]);
  return kept;
}

std::vector<bool> possible_after(const net::Net& net, const Run& run) {
  const Prospect prospect(net, run);
  std::vector<bool> possible(net.transitions().size());
  for (std::uint32_t index = 0; index < possible.size(); ++index)
    possible[index] = prospect.possible({index});
  return possible;
}

bool never_again(const net::Net& net, const Run& run, const std::vector<TransitionId>& transitions) {
  const Prospect prospect(net, run);
  return std::ranges::none_of(transitions, [&](TransitionId id) { return prospect.possible(id); });
}

namespace {

/// Goes on with a run, one firing at a time.
class Continuation {
 public:
  Continuation(const net::Net& net, Run run)
      : net_(net), run_(std::move(run)), tokens_(net::marking_after(net, run_)) {
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
      const TransitionId id{index};
      if (net[id].condition.truth == net::Condition::Truth::never) continue;
      if (!net[id].subsystem.valid()) {
        for (const Arc& arc : net.postset(id)) of(net[arc.place].subsystem).push_back(id);  // it starts them
        continue;
      }
      of(net[id].subsystem).push_back(id);
      for (const auto arcs : {net.preset(id), net.postset(id)})
        for (const Arc& arc : arcs)
          if (net[arc.place].fused()) users_[arc.place.value].insert(net[id].subsystem);
    }
  }

  /// False: not everybody came to rest.
  bool bring_to_rest(const std::vector<TransitionId>& stuck, const explore::Budget& budget) {
    std::vector<net::SubsystemId> concerned;
    for (const TransitionId id : stuck)
      if (net_[id].subsystem.value < of_subsystem_.size()) concern(net_[id].subsystem, concerned);
    std::size_t firings = 0;
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t next = 0; next < concerned.size(); ++next) {
        budget.check();
        while (fire_one_of(concerned[next])) {
          moved = true;
          if (++firings > most_firings_each * concerned.size()) return false;
        }
        for (const std::uint32_t place : lacking(concerned[next]))
          for (const net::SubsystemId user : users_[place]) concern(user, concerned);
      }
    }
    return true;
  }

  [[nodiscard]] Run run() && { return std::move(run_); }

 private:
  static constexpr std::size_t most_firings_each = 64;

  std::vector<TransitionId>& of(net::SubsystemId subsystem) {
    if (!subsystem.valid()) return nobodys_;
    if (subsystem.value >= of_subsystem_.size()) of_subsystem_.resize(subsystem.value + 1);
    return of_subsystem_[subsystem.value];
  }

  void concern(net::SubsystemId subsystem, std::vector<net::SubsystemId>& concerned) {
    if (concerned_.insert(subsystem).second) concerned.push_back(subsystem);
  }

  bool fire_one_of(net::SubsystemId subsystem) {
    for (const TransitionId id : of_subsystem_[subsystem.value]) {
      if (!net::enabled(net_, id, tokens_)) continue;
      net::fire(net_, id, tokens_);
      run_.push_back(id);
      return true;
    }
    return false;
  }

  /// The places of channels that a subsystem at rest waits for.
  [[nodiscard]] std::set<std::uint32_t> lacking(net::SubsystemId subsystem) const {
    std::set<std::uint32_t> places;
    for (const TransitionId id : of_subsystem_[subsystem.value]) {
      const auto inputs = net_.preset(id);
      if (std::ranges::none_of(inputs, [&](const Arc& arc) { return suffices(arc); })) continue;
      for (const Arc& arc : inputs)
        if (!suffices(arc) && net_[arc.place].fused()) places.insert(arc.place.value);
    }
    return places;
  }

  [[nodiscard]] bool suffices(const Arc& arc) const { return net::suffices(tokens_, arc); }

  const net::Net& net_;
  Run run_;
  net::Marking tokens_;
  std::vector<std::vector<TransitionId>> of_subsystem_;  // those that start it too
  std::vector<TransitionId> nobodys_;
  std::map<std::uint32_t, std::set<net::SubsystemId>> users_;  // per place of a channel
  std::set<net::SubsystemId> concerned_;
};

}  // namespace

Run until_all_concerned_wait(const net::Net& net, Run run, const std::vector<TransitionId>& stuck,
                             const explore::Budget& budget) {
  Continuation further(net, run);
  return further.bring_to_rest(stuck, budget) ? std::move(further).run() : run;
}

}  // namespace tessera::verify
