// Memory cells with few values as facts of the net.

#include <algorithm>
#include <optional>
#include <utility>

#include "layers/known_facts.hpp"
#include "spec/conditions/memory_part.hpp"

namespace tessera::layers {
namespace {

using FactKind = net::Parts::Fact::Kind;

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

/// The values of a cell in each behaviour: the start leads to the first one, and an entry that may be taken with a value
/// leads on with that value changed. Other facts are free.
void KnownFacts::find_reached(net::FactId cell) {
  const std::uint32_t number = of(cell).subject;
  const spec::FewValues& few = *subsystem_.memory[number].few;
  if (few.member_count <= most_members || subsystem_.behaviours.empty()) return;
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
  reach(subsystem_.start, 0, subsystem_.behaviours[subsystem_.start].sets);
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
      first.emplace_back(fact, 0);
  }
  return changed(changes, first, subsystem_.start).front();
}

std::vector<net::FactId> KnownFacts::memory() const {
  std::vector<net::FactId> all;
  for (std::uint32_t number = 0; number < facts_.size(); ++number)
    if (facts_[number].kind == FactKind::memory) all.push_back({first_.value + number});
  return all;
}

}  // namespace tessera::layers
