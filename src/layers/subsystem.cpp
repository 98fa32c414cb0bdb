#include <algorithm>
#include <optional>
#include <utility>

#include "layers/condition_truth.hpp"
#include "layers/sheet.hpp"
#include "spec/model/endings.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {
namespace {

using net::Condition;
using Known = Condition::Known;
using Truth = Condition::Truth;

std::string label(const spec::Expression& expression) {
  if (expression.text.empty() && expression.until_of.valid()) return "until";
  return expression.name.empty() ? expression.text : expression.name;
}

std::string text_of(spec::NextId entry, const spec::Behaviour& behaviour) {
  const spec::When& when = behaviour.next[entry].when;
  switch (when.kind) {
    case spec::When::Kind::always:
      return entry.value == 0 ? "no error" : "otherwise";
    case spec::When::Kind::never:
      return "never";
    case spec::When::Kind::error:
      return "error";
    case spec::When::Kind::terminal:
      return label(behaviour.terminal.expressions[when.expression]);
    case spec::When::Kind::named_error:
      return label(behaviour.error.expressions[when.expression]);
    case spec::When::Kind::expression:
      return label(when.text);
  }
  return {};
}

/// The truth of an entry of `next` over the possible endings.
Known known(const spec::Endings& endings, spec::NextId entry, bool with_failures) {
  std::optional<Truth> all;
  bool exhaustive = true;
  for (const spec::Ending ending : spec::all_endings) {
    if (!endings.possible(ending) || (ending == spec::Ending::failure && !with_failures)) continue;
    const Truth one = truth(endings.taken(entry, ending));
    all = !all || *all == one ? one : Truth::free;
    exhaustive = exhaustive && !endings.none_possible(ending);
  }
  return {all.value_or(Truth::never), exhaustive};
}

template <class Possible>
Condition::After after(Possible possible) {
  return {possible(spec::Ending::terminal), possible(spec::Ending::error) || possible(spec::Ending::failure)};
}

/// An entry of `next`, as it is drawn for some values of the facts that its list asks for.
struct Drawn {
  spec::NextId entry;
  KnownFacts::Values values;
  Condition condition;
};

/// The knowledge about the list with certain values: without and with failures.
struct Knowledge {
  spec::Endings certain, failing;
};

Condition condition_of(spec::NextId entry, const spec::Behaviour& behaviour, const KnownFacts::Values& values,
                       const Knowledge& knowledge) {
  const Known now = known(knowledge.certain, entry, false);
  const spec::Endings& endings = knowledge.failing;
  Condition made{.kind = Condition::Kind::next,
                 .truth = now.truth,
                 .entry = entry.value,
                 .text = text_of(entry, behaviour),
                 .exhaustive = now.exhaustive};
  made.set_with_failures(known(endings, entry, true));
  made.follows =
      after([&](spec::Ending ending) { return endings.taken(entry, ending) != spec::Truth::never; });
  made.none_follows = after([&](spec::Ending ending) { return endings.none_possible(ending); });
  for (const auto& [fact, value] : values) made.asked.push_back(fact);
  return made;
}

/// The expressions that decide between the entries.
KnownFacts::Expressions expressions_of(const spec::Behaviour& behaviour) {
  KnownFacts::Expressions all;
  const auto add = [&](const spec::Condition& condition) {
    for (const spec::Expression& expression : condition.expressions) all.push_back(&expression);
  };
  for (const spec::Next& next : behaviour.next) {
    if (next.when.kind == spec::When::Kind::expression) all.push_back(&next.when.text);
    if (next.when.kind == spec::When::Kind::terminal) add(behaviour.terminal);
    if (next.when.kind == spec::When::Kind::named_error) add(behaviour.error);
  }
  return all;
}

/// Whether it matters for the list in which way the behaviour has ended: an entry, or the outcome that none holds,
/// follows one of the two alone. t5 and t6 lead to the same place. So the list then asks what they asked, and an
/// entry is drawn only for values with which the behaviour can end in a way that the entry follows.
bool depends_on_ending(const spec::Behaviour& behaviour) {
  const spec::Endings endings(behaviour);
  if (behaviour.is_group() || !endings.possible(spec::Ending::terminal)) return false;
  if (endings.none_possible(spec::Ending::terminal)) return true;
  for (const spec::NextId entry : behaviour.next.ids()) {
    const Condition::After follows =
        after([&](spec::Ending ending) { return endings.taken(entry, ending) != spec::Truth::never; });
    if (follows.terminal != follows.error) return true;
  }
  return false;
}

/// Whether a list has an entry for each of more members of a fleet than are looked at together.
bool is_wide(const spec::Behaviour& behaviour) {
  return std::ranges::any_of(behaviour.next, [](const spec::Next& next) {
    return next.member && next.member->count > KnownFacts::most_members;
  });
}

/// A wide list as it is looked at for one entry: of the entries for the members of a fleet, those before and
/// those behind
/// it count as one each, of which nothing is known.
struct Excerpt {
  spec::Behaviour behaviour;
  spec::NextId entry;
};

Excerpt excerpt_of(const spec::Behaviour& behaviour, spec::NextId entry) {
  Excerpt made;
  made.behaviour.name = behaviour.name;
  made.behaviour.terminal = behaviour.terminal;
  made.behaviour.error = behaviour.error;
  made.behaviour.group = behaviour.group;
  made.behaviour.parent = behaviour.parent;
  made.behaviour.span = behaviour.span;
  spec::Next unknown;
  unknown.when.kind = spec::When::Kind::expression;
  unknown.when.text.text = "unknown";
  for (std::uint32_t at = 0; at < behaviour.next.size();) {
    const spec::Next& next = behaviour.next[spec::NextId{at}];
    const std::uint32_t count = next.member ? next.member->count : 1;
    const bool is_here = entry.value >= at && entry.value < at + count;
    if (next.member && (!is_here || entry.value > at)) made.behaviour.next.push_back(unknown);
    if (is_here) made.entry = made.behaviour.next.next_id();
    if (is_here || !next.member)
      made.behaviour.next.push_back(behaviour.next[is_here ? entry : spec::NextId{at}]);
    if (next.member && is_here && entry.value + 1 < at + count) made.behaviour.next.push_back(unknown);
    at += count;
  }
  return made;
}

/// Each entry of a wide list asks for its own facts alone. The net may then take it although one before it holds.
std::vector<Drawn> entries_of_wide(const spec::Behaviour& behaviour, spec::BehaviourId id,
                                   const KnownFacts& facts) {
  std::vector<Drawn> drawn;
  for (const spec::NextId entry : behaviour.next.ids()) {
    const Excerpt excerpt = excerpt_of(behaviour, entry);
    const spec::Next& next = behaviour.next[entry];
    spec::Behaviour alone;
    alone.terminal = behaviour.terminal;
    alone.error = behaviour.error;
    alone.next.push_back(next);
    std::vector<const spec::Next*> counted;
    if (next.may_be_blocked) counted.push_back(&next);
    for (const KnownFacts::Values& values : facts.assignments(expressions_of(alone), id, counted)) {
      if (next.when.kind == spec::When::Kind::expression &&
          facts.truths(id, values, true)(next.when.text) == spec::Truth::never && !values.empty())
        continue;
      const auto allows = [&facts, values](const spec::Next& one) { return facts.allows(one, values); };
      const Knowledge knowledge{spec::Endings(excerpt.behaviour, facts.truths(id, values, false), allows),
                                spec::Endings(excerpt.behaviour, facts.truths(id, values, true), allows)};
      Condition condition = condition_of(excerpt.entry, excerpt.behaviour, values, knowledge);
      if (!values.empty() && condition.known(true).truth == Truth::never) continue;
      condition.entry = entry.value;
      drawn.push_back({entry, values, std::move(condition)});
    }
  }
  return drawn;
}

/// The entries of `next` with their initial conditions: the first that holds is taken. If they ask for facts, an
/// entry is drawn for the values with which it can be taken, and the last one is also drawn where none can.
std::vector<Drawn> entries_of(const spec::Behaviour& behaviour, spec::BehaviourId id,
                              const KnownFacts& facts) {
  if (behaviour.next.size() == 1 && behaviour.next.front().when.kind == spec::When::Kind::always &&
      !behaviour.next.front().may_be_blocked)
    return {{spec::NextId{0}, {}, Condition{}}};
  if (is_wide(behaviour)) return entries_of_wide(behaviour, id, facts);
  std::vector<const spec::Next*> counted;
  for (const spec::Next& next : behaviour.next)
    if (next.may_be_blocked) counted.push_back(&next);
  KnownFacts::Expressions of_ending;
  if (depends_on_ending(behaviour))
    for (const spec::Condition* condition : {&behaviour.terminal, &behaviour.error})
      for (const spec::Expression& expression : condition->expressions) of_ending.push_back(&expression);
  const std::vector<KnownFacts::Values> assignments =
      facts.assignments(expressions_of(behaviour), id, counted, of_ending);
  std::vector<Knowledge> knowledge;
  for (const KnownFacts::Values& values : assignments) {
    const auto allows = [&facts, values](const spec::Next& entry) { return facts.allows(entry, values); };
    knowledge.push_back({spec::Endings(behaviour, facts.truths(id, values, false), allows),
                         spec::Endings(behaviour, facts.truths(id, values, true), allows)});
  }
  std::vector<Drawn> drawn;
  std::vector<bool> has_way(assignments.size(), false);
  for (const spec::NextId entry : behaviour.next.ids())
    for (std::size_t number = 0; number < assignments.size(); ++number) {
      Condition condition = condition_of(entry, behaviour, assignments[number], knowledge[number]);
      const bool possible = condition.known(true).truth != Truth::never;
      const bool last = entry.value + 1 == behaviour.next.size();
      if (!assignments[number].empty() && !possible && !(last && !has_way[number])) continue;
      has_way[number] = true;
      drawn.push_back({entry, assignments[number], std::move(condition)});
    }
  return drawn;
}

/// Draws the behaviours and groups that a subsystem or a group consists of, of which one is active.
class FlowPen {
 public:
  /// inside: the group; none: the subsystem itself.
  FlowPen(Draft& draft, Sheet& sheet, net::SubsystemId id, spec::BehaviourId inside)
      : draft_(draft),
        sheet_(sheet),
        id_(id),
        inside_(inside),
        subsystem_(draft.model.subsystem(id)),
        facts_(draft.facts[id]),
        nodes_(subsystem_.behaviours.size()) {}

  void pages() {
    for (const spec::BehaviourId behaviour : subsystem_.behaviours.ids())
      if (subsystem_.behaviours[behaviour].parent == inside_)
        nodes_[behaviour] = sheet_.page(page(behaviour));
  }

  void start(spec::BehaviourId first, std::uint32_t in, Step role) {
    KnownFacts::Changed begun;
    // A behaviour that begins in a group has changed memory when the group began.
    if (!inside_.valid()) begun = facts_.changed_at_start(subsystem_.behaviours[first].sets);
    sheet_.transition(words::start, nodes_of(in, begun.before), nodes_of(nodes_[first], begun.after)).role =
        role;
  }

  void entries(std::uint32_t out) {
    for (const spec::BehaviourId index : subsystem_.behaviours.ids())
      if (subsystem_.behaviours[index].parent == inside_) leave(index, out);
  }

 private:
  [[nodiscard]] net::PageId page(spec::BehaviourId behaviour) {
    return subsystem_.behaviours[behaviour].is_group() ? draw_group(draft_, sheet_.id(), id_, behaviour)
                                                       : draw_behaviour(draft_, sheet_.id(), id_, behaviour);
  }

  FactPen::Nodes nodes_of(std::uint32_t node, const KnownFacts::Values& values) {
    FactPen::Nodes nodes{node};
    for (const auto& [fact, value] : values)
      nodes.push_back(sheet_.member(facts_.name_of(fact, value), facts_.place_of(fact, value)));
    return nodes;
  }

  void leave(spec::BehaviourId index, std::uint32_t out) {
    const spec::Behaviour& behaviour = subsystem_.behaviours[index];
    for (const Drawn& entry : entries_of(behaviour, index, facts_)) {
      const spec::Next& next = behaviour.next[entry.entry];
      const std::string name = std::string(words::leave) + std::string(behaviour.label()) + "_" +
                               std::to_string(entry.entry.value + 1);
      const std::uint32_t to = next.behaviour.valid() ? nodes_[next.behaviour] : out;
      for (const KnownFacts::Changed& changed : facts_.changed(next.sets, entry.values, index)) {
        std::string full = name;
        for (const auto& [fact, value] : changed.before) full += "." + facts_.name_of(fact, value);
        net::PageTransition& drawn = sheet_.transition(full, nodes_of(nodes_[index], changed.before),
                                                       nodes_of(to, changed.after), entry.condition);
        drawn.span = next.span;
        drawn.role = behaviour.is_group() ? Step::leave_group : Step::leave;
      }
    }
  }

  Draft& draft_;
  Sheet& sheet_;
  net::SubsystemId id_;
  spec::BehaviourId inside_;
  const spec::Subsystem& subsystem_;
  const KnownFacts& facts_;
  Numbered<spec::BehaviourId, std::uint32_t> nodes_;  // those that it draws
};

}  // namespace

/// A group is a page whose net is that of a subsystem again (paper, sec. II). Its own places have the layer of a
/// subsystem, its behaviour, and no role: a token in the input and output place of a subsystem means more.
net::PageId draw_group(Draft& draft, net::PageId parent, net::SubsystemId id, spec::BehaviourId group) {
  const spec::Behaviour& behaviour = draft.model.subsystem(id).behaviours[group];
  Sheet sheet(draft, parent, net::Layer::subsystem, std::string(behaviour.label()), id, behaviour.span);
  sheet.drawn().behaviour = group;
  const std::uint32_t in = sheet.place(words::input);
  FlowPen flow(draft, sheet, id, group);
  flow.pages();
  const std::uint32_t out = sheet.place(words::output);
  flow.start(behaviour.group->start, in, Step::begin_group);
  flow.entries(out);
  return sheet.finish(in, out);
}

/// Layer 3, a subsystem (paper, sec. IV-C): a graph of behaviours, of which one is active.
net::PageId draw_subsystem(Draft& draft, net::PageId parent, net::SubsystemId id) {
  const spec::Subsystem& subsystem = draft.model.subsystem(id);
  Sheet sheet(draft, parent, net::Layer::subsystem, subsystem.name, id, subsystem.span);
  const std::uint32_t in = sheet.input();
  FlowPen flow(draft, sheet, id, {});
  flow.pages();
  const std::uint32_t out = sheet.output();
  const KnownFacts& facts = draft.facts[id];
  for (const net::FactId cell : facts.memory())
    for (std::uint32_t value = 0; value < facts.value_count(cell); ++value)
      static_cast<void>(sheet.member(facts.name_of(cell, value), facts.place_of(cell, value)));
  flow.start(subsystem.start, in, Step::start);
  flow.entries(out);
  return sheet.finish(in, out);
}

}  // namespace tessera::layers
