// Memory cells with few values as facts of the net.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "layers/known_facts.hpp"
#include "spec/conditions/memory_part.hpp"

namespace tessera::layers {
namespace {

using FactKind = net::Parts::Fact::Kind;
using net::Invariant;
using net::PlaceId;
using Terms = std::vector<Invariant::Term>;

/// A transition of the page of a subsystem, as one cell sees it.
struct Move {
  std::uint32_t to = 0;                       // node
  std::optional<std::uint32_t> takes, gives;  // values of the cell
};

/// The values that one cell can have at each node of the page of its subsystem.
class Reached {
 public:
  Reached(const net::HierarchicalNet& pages, const net::Page& page, net::FactId cell, std::size_t values)
      : moves_(page.nodes.size()), values_(page.nodes.size(), std::vector<bool>(values, false)) {
    const auto value = [&](std::uint32_t node) -> std::optional<std::uint32_t> {
      const net::Node& drawn = page.nodes[node];
      if (!drawn.fusion.valid() || pages.fusions[drawn.fusion.value].fact != cell) return std::nullopt;
      return pages.fusions[drawn.fusion.value].value;
    };
    for (const net::PageTransition& transition : page.transitions) {
      Move move;
      std::uint32_t from = 0;
      for (const std::uint32_t node : transition.inputs)
        if (const auto taken = value(node))
          move.takes = taken;
        else if (!page.nodes[node].fusion.valid())
          from = node;
      for (const std::uint32_t node : transition.outputs)
        if (const auto given = value(node))
          move.gives = given;
        else if (!page.nodes[node].fusion.valid())
          move.to = node;
      moves_[from].push_back(move);
    }
    reach(page.input, 0);
    while (!open_.empty()) {
      const auto [node, now] = open_.back();
      open_.pop_back();
      for (const Move& move : moves_[node])
        if (!move.takes || *move.takes == now) reach(move.to, move.gives.value_or(now));
    }
  }

  /// The nodes at which the cell has the value; empty: also another one at one of them, or none of them is a page.
  [[nodiscard]] std::vector<std::uint32_t> alone_at(std::uint32_t value, const net::Page& page) const {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t node = 0; node < values_.size(); ++node) {
      if (!values_[node][value]) continue;
      if (!page.nodes[node].page.valid() || std::ranges::count(values_[node], true) != 1) return {};
      nodes.push_back(node);
    }
    return nodes;
  }

 private:
  void reach(std::uint32_t node, std::uint32_t value) {
    if (values_[node][value]) return;
    values_[node][value] = true;
    open_.emplace_back(node, value);
  }

  std::vector<std::vector<Move>> moves_;   // per node
  std::vector<std::vector<bool>> values_;  // per node and value
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open_;
};

/// Per page of a behaviour of that subsystem, the places that its token may be at.
std::unordered_map<std::uint32_t, Terms> terms_of_pages(const net::HierarchicalNet& pages,
                                                        const net::Net& net, const Invariant& token,
                                                        net::PageId subsystem) {
  std::unordered_map<std::uint32_t, Terms> terms;
  for (const Invariant::Term& term : token.terms)
    for (net::PageId page = net[term.place].page; page.valid(); page = pages.pages[page.value].parent)
      if (pages.pages[page.value].parent == subsystem) terms[page.value].push_back(term);
  return terms;
}

}  // namespace

void KnownFacts::find_memory() {
  for (std::uint32_t number = 0; number < subsystem_.memory.size(); ++number) {
    const spec::Field& cell = subsystem_.memory[number];
    if (cell.few)
      add({.kind = FactKind::memory, .subject = number}, "memory." + cell.name, cell.few->names, cell.span);
  }
  for (const net::FactId cell : memory()) find_reached(cell);
}

net::FactId KnownFacts::fact_of(FactKind kind, std::uint32_t subject) const {
  const auto& numbers = by_subject_.at(static_cast<std::size_t>(kind));
  const auto found = numbers.find(subject);
  return found == numbers.end() ? net::FactId{} : found->second;
}

/// The values of a cell in each behaviour: the start leads to the initial one, and an entry that may be
/// taken with a value leads on with that value changed. Other facts are free.
void KnownFacts::find_reached(net::FactId cell) {
  const std::uint32_t number = of(cell).subject;
  const spec::FewValues& few = *subsystem_.memory[number].few;
  const bool has_groups =
      std::ranges::any_of(subsystem_.behaviours, [](const spec::Behaviour& one) { return one.is_group(); });
  if (few.member_count <= most_members || subsystem_.behaviours.empty() || has_groups) return;
  Numbered<spec::BehaviourId, std::vector<bool>> reached(subsystem_.behaviours.size(),
                                                         std::vector<bool>(few.names.size(), false));
  std::vector<std::pair<spec::BehaviourId, std::uint32_t>> open;
  const auto reach = [&](spec::BehaviourId behaviour, std::uint32_t value,
                         const std::vector<spec::Change>& changes) {
    for (const spec::Change& change : changes)
      if (change.cell == number) value = change.value;
    if (reached[behaviour][value]) return;
    reached[behaviour][value] = true;
    open.emplace_back(behaviour, value);
  };
  reach(subsystem_.start, few.initial, subsystem_.behaviours[subsystem_.start].sets);
  while (!open.empty()) {
    const auto [behaviour, value] = open.back();
    open.pop_back();
    const spec::TruthOf truth = truths(behaviour, {{cell, value}}, true);
    for (const spec::Next& next : subsystem_.behaviours[behaviour].next) {
      const bool is_expression = next.when.kind == spec::When::Kind::expression;
      if (!next.behaviour.valid() || (is_expression && truth(next.when.text) == spec::Truth::never)) continue;
      reach(next.behaviour, value, next.sets);
    }
  }
  reached_.emplace(cell.value, std::move(reached));
}

std::vector<std::uint32_t> KnownFacts::values_in(net::FactId fact, spec::BehaviourId behaviour) const {
  const auto found = reached_.find(fact.value);
  std::vector<std::uint32_t> values;
  for (std::uint32_t value = 0; value < value_count(fact); ++value)
    if (found == reached_.end() || found->second[behaviour][value]) values.push_back(value);
  return values;
}

KnownFacts::Question KnownFacts::memory_in(std::span<const spec::Token> part,
                                           std::optional<std::uint32_t> member) const {
  std::optional<spec::MemoryPart> found = spec::memory_part(part, subsystem_.memory, member);
  if (!found) return {};
  return {.fact = fact_of(FactKind::memory, found->cell), .holds = std::move(found->holds)};
}

/// Changes those cells that `values` knows; false: a counter would leave its range.
bool KnownFacts::apply(const std::vector<spec::Change>& changes, Values& values) const {
  for (const spec::Change& change : changes) {
    const auto known =
        std::ranges::find(values, fact_of(FactKind::memory, change.cell), &Values::value_type::first);
    if (known == values.end()) continue;
    const auto after = change.after(known->second, *subsystem_.memory[change.cell].few);
    if (!after) return false;
    known->second = *after;
  }
  return true;
}

spec::Truth KnownFacts::allows(const spec::Next& entry, const Values& values) const {
  if (!entry.may_be_blocked) return spec::Truth::always;
  Values after = values;
  if (!apply(entry.sets, after)) return spec::Truth::never;
  const bool knows_all = std::ranges::all_of(entry.sets, [&](const spec::Change& change) {
    const net::FactId fact = fact_of(FactKind::memory, change.cell);
    return change.step == 0 || std::ranges::find(values, fact, &Values::value_type::first) != values.end();
  });
  return knows_all ? spec::Truth::always : spec::Truth::free;
}

std::vector<KnownFacts::Changed> KnownFacts::changed(const std::vector<spec::Change>& changes,
                                                     const Values& known, spec::BehaviourId behaviour) const {
  std::vector<Values> befores{known};
  for (const spec::Change& change : changes) {
    const net::FactId fact = fact_of(FactKind::memory, change.cell);
    const std::vector<std::uint32_t> values = values_in(fact, behaviour);
    std::vector<Values> more;
    for (const Values& before : befores) {
      if (std::ranges::find(before, fact, &Values::value_type::first) != before.end()) {
        more.push_back(before);
        continue;
      }
      for (const std::uint32_t value : values) more.emplace_back(before).emplace_back(fact, value);
    }
    befores = std::move(more);
  }
  std::vector<Changed> all;
  for (Values& before : befores) {
    std::ranges::sort(before);
    Values after = before;
    if (apply(changes, after)) all.push_back({std::move(before), std::move(after)});
  }
  if (all.empty()) all.push_back({known, known});
  return all;
}

KnownFacts::Changed KnownFacts::changed_at_start(const std::vector<spec::Change>& changes) const {
  Values first;
  for (const spec::Change& change : changes) {
    const net::FactId fact = fact_of(FactKind::memory, change.cell);
    if (std::ranges::find(first, fact, &Values::value_type::first) == first.end())
      first.emplace_back(fact, subsystem_.memory[change.cell].few->initial);
  }
  return changed(changes, first, subsystem_.start).front();
}

net::FactId KnownFacts::goal_told_by(net::ChannelId channel) const {
  const spec::ChannelEnd& end = model_.channels[channel].to;
  if (end.instance != id_) return {};
  for (std::uint32_t cell = 0; cell < subsystem_.memory.size(); ++cell) {
    const std::optional<spec::FewValues>& few = subsystem_.memory[cell].few;
    if (few && few->goal && few->goal->progress == end.buffer) return fact_of(FactKind::memory, cell);
  }
  return {};
}

std::vector<net::FactId> KnownFacts::memory() const {
  std::vector<net::FactId> all;
  for (std::uint32_t number = 0; number < facts_.size(); ++number)
    if (facts_[number].kind == FactKind::memory) all.push_back({first_.value + number});
  return all;
}

std::vector<Invariant> memory_invariants(const spec::Model& model, const net::HierarchicalNet& pages,
                                         const net::Net& net, const std::vector<Invariant>& tokens) {
  std::unordered_map<std::uint32_t, std::vector<PlaceId>> places;  // per fact
  for (std::uint32_t index = 0; index < net.places().size(); ++index)
    if (net.places()[index].fact.valid()) places[net.places()[index].fact.value].push_back({index});
  std::vector<Invariant> all;
  for (std::uint32_t number = 0; number < pages.pages.size(); ++number) {
    const net::Page& page = pages.pages[number];
    if (page.layer != net::Layer::subsystem) continue;
    const spec::Subsystem& subsystem = model.subsystem(page.subsystem);
    if (std::ranges::any_of(subsystem.behaviours, [](const spec::Behaviour& one) { return one.is_group(); }))
      continue;
    for (std::uint32_t id = 0; id < pages.parts.facts.size(); ++id) {
      const net::Parts::Fact& fact = pages.parts.facts[id];
      if (fact.kind != net::Parts::Fact::Kind::memory || fact.subsystem != page.subsystem) continue;
      const spec::FewValues& few = *subsystem.memory[fact.subject].few;
      if (few.member_count <= KnownFacts::most_members) continue;
      const Reached reached(pages, page, {id}, few.names.size());
      const auto terms = terms_of_pages(pages, net, tokens[page.subsystem.value], {number});
      for (std::uint32_t value = 1; value < few.names.size(); ++value) {
        const std::vector<std::uint32_t> nodes = reached.alone_at(value, page);
        if (nodes.empty()) continue;
        Invariant invariant{
            fact.name + " is " + few.names[value] + " in the behaviours of that value", {}, 1};
        for (const std::uint32_t node : nodes)
          if (const auto found = terms.find(page.nodes[node].page.value); found != terms.end())
            invariant.terms.insert(invariant.terms.end(), found->second.begin(), found->second.end());
        for (const PlaceId place : places[id])
          if (net[place].value != value) invariant.terms.push_back({place});
        all.push_back(std::move(invariant));
      }
    }
  }
  return all;
}

}  // namespace tessera::layers
