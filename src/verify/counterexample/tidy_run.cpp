#include "verify/counterexample/tidy_run.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "explore/explore.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::Arc;
using net::TransitionId;
using Run = std::vector<TransitionId>;

/// Subsystems in a run beyond which a search for a shorter one has no prospect.
constexpr std::size_t most_searched = 12;

bool one_token_at_most(const explore::Marking& marking) {
  return std::ranges::all_of(marking, [](explore::Tokens tokens) { return tokens <= 1; });
}

/// The marking after the run. nullopt: it is no run of the net, or a place holds two tokens at some time.
std::optional<explore::Marking> end_of(const explore::PtNet& net, const Run& run) {
  explore::Marking marking = net.initial();
  if (!one_token_at_most(marking)) return std::nullopt;
  for (const TransitionId id : run) {
    if (!net.enabled(id.value, marking)) return std::nullopt;
    net.fire(id.value, marking);
    for (const explore::Touch& touch : net.of_transition(id.value))
      if (marking[touch.node] > 1) return std::nullopt;
  }
  return marking;
}

// ---------------------------------------------------------------------------------------------- shorter

/// The shortest run to the same end of the net with only the transitions of the run.
Run searched_again(const net::Net& net, const explore::Marking& end, const Run& run,
                   const explore::Budget& budget) {
  std::set<net::SubsystemId> subsystems;
  for (const TransitionId id : run) subsystems.insert(net[id].subsystem);
  if (subsystems.size() > most_searched) return run;
  const std::set<TransitionId> occurring(run.begin(), run.end());
  const Run back(occurring.begin(), occurring.end());
  net::Net used(net.shared_parts());
  std::map<std::uint32_t, net::PlaceId> local;  // of the places that they touch
  for (const TransitionId id : back)
    for (const auto arcs : {net.preset(id), net.postset(id)})
      for (const Arc& arc : arcs) local[arc.place.value];
  std::vector<Formula> same;
  for (auto& [place, there] : local) {
    there = used.add(net.places()[place]);
    const Formula marked = Formula::marked(there);
    same.push_back(end[place] > 0 ? marked : Formula::negation(marked));
  }
  const auto moved = [&](std::span<const Arc> arcs) {
    std::vector<Arc> there;
    for (const Arc& arc : arcs) there.push_back({local[arc.place.value], arc.weight});
    return there;
  };
  for (const TransitionId id : back) used.add(net[id], moved(net.preset(id)), moved(net.postset(id)));
  explore::Limits limits = budget.left();
  limits.markings = 100'000;  // rather than time: the same run on every machine
  limits.progress = nullptr;
  const explore::Answer answer = explore::find(explore::PtNet(used), Formula::all(std::move(same)), limits);
  if (answer.kind == explore::Answer::Kind::unknown) budget.check();
  if (answer.kind != explore::Answer::Kind::yes || answer.trace.firings.size() >= run.size()) return run;
  Run shorter;
  for (const TransitionId id : answer.trace.firings) shorter.push_back(back[id.value]);
  return shorter;
}

/// Leaves out rounds: firings of one subsystem after which its own places are marked as before. Alone if the
/// round gives back to the channels what it takes, else with the next round of each subsystem it deals with.
class RoundRemoval {
 public:
  RoundRemoval(const net::Net& net, const explore::PtNet& compiled, const explore::Marking& end,
               const explore::Budget& budget)
      : net_(net), compiled_(compiled), end_(end), budget_(budget) {}

  Run shortened(Run run) {
    for (std::size_t tries = 0; tries < most_tries && steps_left_ > 0;) {
      const std::vector<Round> rounds = rounds_of(run);
      bool removed = false;
      for (std::size_t index = 0; index < rounds.size() && !removed; ++index) {
        if (++tries > most_tries || steps_left_ == 0) break;
        budget_.check();
        Run left = without(run, closed(rounds, index));
        take_steps(run.size());
        if (left.size() == run.size() || end_of(compiled_, left) != end_) continue;
        run = std::move(left);
        removed = true;
      }
      if (!removed) break;
    }
    return run;
  }

 private:
  static constexpr std::size_t most_tries = 400;
  struct Round {
    net::SubsystemId subsystem;
    std::vector<std::size_t> firings;
    std::map<std::uint32_t, int> effect;  // on fused places
  };

  void take_steps(std::size_t steps) { steps_left_ -= std::min(steps, steps_left_); }

  /// Its sums over two sets of places are equal if the sets are, and hardly ever else. Whether a round
  /// may be left out is checked afterwards.
  static std::uint64_t code(std::uint32_t place) {
    std::uint64_t mixed = (std::uint64_t{place} + 1) * 0x9e3779b97f4a7c15ULL;
    mixed ^= mixed >> 29U;
    mixed *= 0xbf58476d1ce4e5b9ULL;
    return mixed ^ (mixed >> 32U);
  }

  /// The shortest rounds that end with each firing.
  std::vector<Round> rounds_of(const Run& run) {
    std::map<net::SubsystemId, std::vector<std::size_t>> own;
    for (std::size_t at = 0; at < run.size(); ++at)
      if (net_[run[at]].subsystem.valid()) own[net_[run[at]].subsystem].push_back(at);
    std::vector<Round> rounds;
    for (const auto& [subsystem, firings] : own) {
      std::set<std::uint32_t> marked;
      std::uint64_t sum = 0;  // of its codes
      std::unordered_map<std::uint64_t, std::size_t> seen;
      for (std::size_t at = 0; at < firings.size(); ++at) {
        seen[sum] = at;
        for (const Arc& arc : net_.preset(run[firings[at]]))
          if (marked.erase(arc.place.value) > 0) sum -= code(arc.place.value);
        for (const Arc& arc : net_.postset(run[firings[at]]))
          if (!net_[arc.place].fused() && marked.insert(arc.place.value).second) sum += code(arc.place.value);
        const auto before = seen.find(sum);
        if (before == seen.end()) continue;
        Round& round = rounds.emplace_back();
        round.subsystem = subsystem;
        round.firings.assign(firings.begin() + static_cast<std::ptrdiff_t>(before->second),
                             firings.begin() + static_cast<std::ptrdiff_t>(at) + 1);
        for (const std::size_t firing : round.firings) add_effect(run[firing], round.effect);
        take_steps(round.firings.size());
      }
    }
    take_steps(run.size());
    std::ranges::stable_sort(rounds, {}, [](const Round& round) { return round.firings.front(); });
    return rounds;
  }

  void add_effect(TransitionId id, std::map<std::uint32_t, int>& effect) const {
    for (const Arc& arc : net_.preset(id))
      if (net_[arc.place].fused()) --effect[arc.place.value];
    for (const Arc& arc : net_.postset(id))
      if (net_[arc.place].fused()) ++effect[arc.place.value];
  }

  /// The firings of a round and of those that undo its effect on channels.
  [[nodiscard]] std::set<std::size_t> closed(const std::vector<Round>& rounds, std::size_t first) {
    std::set<std::size_t> firings(rounds[first].firings.begin(), rounds[first].firings.end());
    std::set<net::SubsystemId> members{rounds[first].subsystem};
    std::map<std::uint32_t, int> open = rounds[first].effect;
    for (bool grew = true; grew && steps_left_ > 0;) {
      budget_.check();
      grew = false;
      std::erase_if(open, [](const auto& entry) { return entry.second == 0; });
      if (open.empty()) break;
      for (std::size_t index = 0; index < rounds.size() && !grew; ++index) {
        const Round& round = rounds[index];
        take_steps(round.effect.size());
        const bool undoes = std::ranges::any_of(round.effect, [&](const auto& entry) {
          const auto found = open.find(entry.first);
          return found != open.end() && found->second * entry.second < 0;
        });
        if (!undoes || !members.insert(round.subsystem).second) continue;
        firings.insert(round.firings.begin(), round.firings.end());
        for (const auto& [place, tokens] : round.effect) open[place] += tokens;
        grew = true;
      }
    }
    return firings;
  }

  static Run without(const Run& run, const std::set<std::size_t>& firings) {
    Run left;
    for (std::size_t at = 0; at < run.size(); ++at)
      if (!firings.contains(at)) left.push_back(run[at]);
    return left;
  }

  const net::Net& net_;
  const explore::PtNet& compiled_;
  const explore::Marking& end_;
  const explore::Budget& budget_;
  std::size_t steps_left_ =
      4'000'000;  // firings and effects that are looked at: the same run on every machine
};

// ---------------------------------------------------------------------------------------------- grouped

/// The required order: firings that touch a place keep their order at it, so that it never holds two tokens
/// in the new order if it did not in the old.
std::vector<std::vector<std::size_t>> followers(const net::Net& net, const Run& run,
                                                std::vector<std::size_t>& waiting_for) {
  std::vector<std::vector<std::size_t>> after(run.size());
  waiting_for.assign(run.size(), 0);
  std::map<std::uint32_t, std::size_t> last;
  for (std::size_t at = 0; at < run.size(); ++at) {
    std::set<std::size_t> before;
    for (const auto arcs : {net.preset(run[at]), net.postset(run[at])})
      for (const Arc& arc : arcs) {
        const auto [entry, first] = last.emplace(arc.place.value, at);
        if (!first && entry->second != at) before.insert(std::exchange(entry->second, at));
      }
    for (const std::size_t earlier : before) after[earlier].push_back(at);
    waiting_for[at] = before.size();
  }
  return after;
}

/// Goes on with the subsystem at hand for as long as it can, the layers above and then the one that was first
/// in the old order coming next. Outcomes that are the end of their subsystem come last.
Run grouped(const net::Net& net, const Run& run) {
  std::vector<std::size_t> waiting_for;
  const std::vector<std::vector<std::size_t>> after = followers(net, run, waiting_for);
  const auto rank = [&](std::size_t at) { return net[run[at]].role == Step::no_successor ? 1 : 0; };
  std::map<net::SubsystemId, std::set<std::pair<int, std::size_t>>> ready;  // by subsystem
  std::set<std::tuple<int, std::size_t, net::SubsystemId>> order;
  const auto offer = [&](std::size_t at) {
    const net::SubsystemId subsystem = net[run[at]].subsystem;
    ready[subsystem].insert({rank(at), at});
    order.insert({subsystem.valid() ? rank(at) : -1, at, subsystem});
  };
  for (std::size_t at = 0; at < run.size(); ++at)
    if (waiting_for[at] == 0) offer(at);
  Run result;
  net::SubsystemId acting;
  while (!order.empty()) {
    const bool goes_on = !ready[acting].empty() && ready[acting].begin()->first == 0;
    if (!goes_on) acting = std::get<2>(*order.begin());
    const auto [its_rank, at] = *ready[acting].begin();
    ready[acting].erase(ready[acting].begin());
    order.erase({acting.valid() ? its_rank : -1, at, acting});
    result.push_back(run[at]);
    for (const std::size_t next : after[at])
      if (--waiting_for[next] == 0) offer(next);
  }
  return result;
}

}  // namespace

std::vector<TransitionId> tidy(const net::Net& net, std::vector<TransitionId> run,
                               const explore::Budget& budget) {
  budget.check();
  const explore::PtNet compiled(net);
  const std::optional<explore::Marking> end = end_of(compiled, run);
  if (!end) return run;
  run = RoundRemoval(net, compiled, *end, budget).shortened(std::move(run));
  run = searched_again(net, *end, run, budget);
  return grouped(net, run);
}

}  // namespace tessera::verify
