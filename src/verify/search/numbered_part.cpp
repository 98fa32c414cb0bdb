#include "verify/search/numbered_part.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

namespace tessera::verify {
namespace {

using explore::Formula;
using Numbers = NumberedPart::Numbers;
using Step = NumberedPart::Step;

constexpr std::size_t most_tokens = 2'000'000;  // in all markings of a part

/// The marked places, one character each.
using Marking = std::u32string;

bool marks(const Marking& marking, std::uint32_t place) {
  return std::binary_search(marking.begin(), marking.end(), static_cast<char32_t>(place));
}

/// nullopt: it cannot be fired, or two tokens would meet.
std::optional<Marking> fired(const Marking& before, const Numbers& in, const Numbers& out) {
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

/// The markings of a part that are reached.
class PartGraph {
 public:
  PartGraph(const NumberedPart& part, const explore::Budget& budget)
      : part_(part), budget_(budget), seen_(part.places, false), takers_(part.places) {
    for (const Formula* formula : {&part.from, &part.goal}) see(*formula);
    for (const NumberedPart::Set& set : part.sets)
      for (const NumberedPart::Member& member : set) {
        if (!member.is_outside) continue;
        if (member.place >= sets_with_.size()) sets_with_.resize(member.place + 1, 0);
        ++sets_with_[member.place];
      }
    for (std::uint32_t step = 0; step < part.steps.size(); ++step)
      for (const std::uint32_t place : part.steps[step].in) takers_[place].push_back(step);
    for (std::uint32_t step = 0; step < part.steps.size(); ++step)
      if (part.steps[step].in.empty()) free_.push_back(step);
    explore();
  }

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// It has more markings than are searched.
  [[nodiscard]] bool is_too_large() const { return is_too_large_; }

  [[nodiscard]] bool holds(const Formula& formula, std::size_t node) const {
    switch (formula.kind) {
      case Formula::Kind::at_least:
        return marks(*nodes_[node], formula.node);
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

  /// The places outside that decide what the markings can do.
  [[nodiscard]] Numbers needs_of(const std::vector<bool>& markings) const {
    std::set<std::uint32_t> all;
    for (std::size_t node = 0; node < size(); ++node) {
      if (!markings[node]) continue;
      for (const Edge& edge : edges_[node])
        if (const Step& step = part_.steps[edge.step]; step.is_certain)
          all.insert(step.needs.begin(), step.needs.end());
    }
    return {all.begin(), all.end()};
  }

 private:
  struct Edge {
    std::uint32_t to, step;
  };

  void see(const Formula& formula) {
    if (formula.kind == Formula::Kind::at_least) seen_[formula.node] = true;
    for (const Formula& part : formula.parts) see(part);
  }
  [[nodiscard]] bool is_seen(const Step& step) const {
    const auto seen = [&](std::uint32_t place) { return seen_[place]; };
    return step.is_goal || std::ranges::any_of(step.in, seen) || std::ranges::any_of(step.out, seen);
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
          const std::vector<std::uint32_t>& takers = takers_[place];
          if (takers.size() != 1 || !part_.steps[takers.front()].is_alone) continue;
          const Step& step = part_.steps[takers.front()];
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
    add(after_lonely_steps({part_.initial.begin(), part_.initial.end()}));
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      if (node % 256 == 0) budget_.check();
      is_too_large_ = tokens_ > most_tokens;
      if (is_too_large_) return;
      const Marking& marking = *nodes_[node];
      for (const char32_t place : marking)
        for (const std::uint32_t step : takers_[place])
          if (part_.steps[step].in.front() == place) go(node, step);
      for (const std::uint32_t step : free_) go(node, step);
    }
  }

  void go(std::size_t node, std::uint32_t step) {
    std::optional<Marking> next = fired(*nodes_[node], part_.steps[step].in, part_.steps[step].out);
    if (!next) return;
    const std::uint32_t to = add(after_lonely_steps(std::move(*next)));
    edges_[node].push_back({to, step});
  }

  [[nodiscard]] bool leads(const Edge& edge, const std::vector<bool>& goal) const {
    const Step& step = part_.steps[edge.step];
    return step.is_certain && (goal[edge.to] || step.is_goal);
  }

  /// A step towards the goal, with those of its needs that are open.
  struct Way {
    Numbers needs{};
    bool needs_one = false;  ///< it has no others
  };

  /// Whether the token of a member of a set is or can be passed to a place. is_only: it is the only one that is needed;
  /// otherwise passing it on must change no other set.
  [[nodiscard]] bool passes(const NumberedPart::Set& set, const NumberedPart::Member& member,
                            std::uint32_t to, bool is_only, int moves = 0) const {
    constexpr int most_moves = 4;
    if (member.place == to) return true;
    return moves < most_moves && (is_only || sets_with_[member.place] == 1) &&
           std::ranges::any_of(member.next, [&](std::uint32_t next) {
             return passes(set, set[next], to, is_only, moves + 1);
           });
  }

  /// The ways that are left if the token of the set is in this member; inside of the part: none outside holds it.
  [[nodiscard]] std::vector<Way> ways_from(const NumberedPart::Set& set, const NumberedPart::Member& member,
                                           const std::vector<Way>& ways) const {
    std::vector<Way> left;
    for (const Way& way : ways) {
      Way open{.needs_one = way.needs_one};
      bool goes = true;
      for (const std::uint32_t need : way.needs) {
        const bool is_of_set = std::ranges::any_of(
            set, [&](const NumberedPart::Member& one) { return one.is_outside && one.place == need; });
        if (!is_of_set) open.needs.push_back(need);
        goes = goes && (!is_of_set || (member.is_outside && passes(set, member, need, way.needs_one)));
      }
      if (goes) left.push_back(std::move(open));
    }
    return left;
  }

  /// Whether one of the ways is open, wherever the tokens of the sets are.
  [[nodiscard]] bool is_covered(std::uint32_t node, const std::vector<Way>& ways, int sets = 0) const {
    constexpr int most_sets = 4;
    if (std::ranges::any_of(ways, [](const Way& way) { return way.needs.empty(); })) return true;
    if (ways.empty() || sets == most_sets) return false;
    const auto covers = [&](std::uint32_t number) {
      const NumberedPart::Set& set = part_.sets[number];
      return std::ranges::all_of(set, [&](const NumberedPart::Member& member) {
        return (!member.is_outside && !marks(*nodes_[node], member.place)) ||
               is_covered(node, ways_from(set, member, ways), sets + 1);
      });
    };
    return std::ranges::any_of(part_.sets_of[ways.front().needs.front()], covers);
  }

  /// Whether there is a step towards the goal, whatever the places hold that are left out.
  [[nodiscard]] bool can_go(std::uint32_t node, const std::vector<bool>& goal) const {
    constexpr std::size_t most_ways = 200;
    std::vector<Way> ways;
    for (const Edge& edge : edges_[node]) {
      if (!leads(edge, goal)) continue;
      const Numbers& needs = part_.steps[edge.step].needs;
      if (needs.empty()) return true;
      ways.push_back({needs, needs.size() == 1});
    }
    return ways.size() <= most_ways && is_covered(node, ways);
  }

  const NumberedPart& part_;
  const explore::Budget& budget_;
  std::size_t tokens_ = 0;
  bool is_too_large_ = false;
  std::vector<bool> seen_;                // per place: the formulas ask about it
  std::vector<std::uint32_t> sets_with_;  // per place outside: how many sets have it
  std::vector<Numbers> takers_;           // per place: steps
  Numbers free_;                          // steps that take nothing of the part
  std::unordered_map<Marking, std::uint32_t> numbers_;
  std::vector<const Marking*> nodes_;
  std::vector<std::vector<Edge>> edges_;
};

/// A part in one row, each list after its length.
class Row {
 public:
  void add(std::size_t number) { text_.push_back(static_cast<char32_t>(number)); }
  void add(const Numbers& numbers) {
    add(numbers.size());
    text_.append(numbers.begin(), numbers.end());
  }
  void add(const Formula& formula) {
    add(static_cast<std::size_t>(formula.kind));
    add(formula.node);
    add(formula.parts.size());
    for (const Formula& part : formula.parts) add(part);
  }
  void add(const Step& step) {
    add(step.in);
    add(step.out);
    add(step.needs);
    add((step.is_certain ? 1U : 0U) | (step.is_alone ? 2U : 0U) | (step.is_goal ? 4U : 0U));
  }
  void add(const NumberedPart::Member& member) {
    add(member.is_outside ? 1U : 0U);
    add(member.place);
    add(member.next);
  }
  template <class Entry>
  void add_all(const std::vector<Entry>& entries) {
    add(entries.size());
    for (const Entry& entry : entries) add(entry);
  }

  std::u32string text_;
};

}  // namespace

std::u32string NumberedPart::written() const {
  Row row;
  row.add(static_cast<std::size_t>(question));
  row.add(from);
  row.add(goal);
  row.add(places);
  row.add(initial);
  row.add_all(steps);
  row.add(sets.size());
  for (const Set& set : sets) row.add_all(set);
  row.add_all(sets_of);
  return std::move(row.text_);
}

NumberedPart::Result NumberedPart::searched(const explore::Budget& budget) const {
  const PartGraph graph(*this, budget);
  Result result{.holds = !graph.is_too_large(), .markings = graph.size()};
  if (graph.is_too_large()) return result;
  std::vector<bool> begin(graph.size()), there(graph.size());
  for (std::size_t node = 0; node < graph.size(); ++node) {
    begin[node] = graph.holds(from, node);
    there[node] = graph.holds(goal, node);
  }
  if (question == Question::never) {
    result.holds = std::ranges::count(begin, true) == 0;
    if (!result.holds) result.helpful = graph.needs_of(std::vector<bool>(graph.size(), true));
    return result;
  }
  const std::vector<bool> asked = question == Question::reaches ? graph.followers(begin, there) : begin;
  const std::vector<bool> certain = graph.certain(there);
  std::vector<bool> lost(graph.size());
  for (std::size_t node = 0; node < graph.size(); ++node) {
    lost[node] = asked[node] && !certain[node];
    if (lost[node]) result.holds = false;
  }
  if (!result.holds) result.helpful = graph.needs_of(lost);
  return result;
}

}  // namespace tessera::verify
