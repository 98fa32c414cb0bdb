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

/// The initial conditions of a behaviour's successors: of the entries of `next`, the first that
/// holds is taken.
Numbered<spec::NextId, Condition> initial_conditions(const spec::Behaviour& behaviour) {
  if (behaviour.next.size() == 1 && behaviour.next.front().when.kind == spec::When::Kind::always)
    return {Condition{}};
  Numbered<spec::NextId, Condition> conditions;
  const spec::Endings endings(behaviour);
  for (const spec::NextId entry : behaviour.next.ids()) {
    const Known now = known(endings, entry, false);
    Condition made{.kind = Condition::Kind::next,
                   .truth = now.truth,
                   .entry = entry.value,
                   .text = text_of(entry, behaviour),
                   .exhaustive = now.exhaustive};
    made.set_with_failures(known(endings, entry, true));
    made.follows =
        after([&](spec::Ending ending) { return endings.taken(entry, ending) != spec::Truth::never; });
    made.none_follows = after([&](spec::Ending ending) { return endings.none_possible(ending); });
    conditions.push_back(std::move(made));
  }
  return conditions;
}

}  // namespace

/// Layer 3, a subsystem (paper, sec. IV-C): a graph of behaviours, of which one is active.
net::PageId draw_subsystem(Draft& draft, net::PageId parent, net::SubsystemId id) {
  const spec::Subsystem& subsystem = draft.model.subsystem(id);
  Sheet sheet(draft, parent, net::Layer::subsystem, subsystem.name, id, subsystem.span);
  const std::uint32_t in = sheet.input();
  Numbered<spec::BehaviourId, std::uint32_t> behaviours;
  for (const spec::BehaviourId behaviour : subsystem.behaviours.ids())
    behaviours.push_back(sheet.page(draw_behaviour(draft, sheet.id(), id, behaviour)));
  const std::uint32_t out = sheet.output();

  sheet.transition(words::start, {in}, {behaviours[subsystem.start]}).role = Step::start;
  for (const spec::BehaviourId index : subsystem.behaviours.ids()) {
    const spec::Behaviour& behaviour = subsystem.behaviours[index];
    const auto conditions = initial_conditions(behaviour);
    for (const spec::NextId entry : behaviour.next.ids()) {
      const spec::Next& next = behaviour.next[entry];
      const std::string name =
          std::string(words::leave) + behaviour.name + "_" + std::to_string(entry.value + 1);
      const std::uint32_t to = next.behaviour.valid() ? behaviours[next.behaviour] : out;
      net::PageTransition& drawn = sheet.transition(name, {behaviours[index]}, {to}, conditions[entry]);
      drawn.span = next.span;
      drawn.role = Step::leave;
    }
  }
  return sheet.finish(in, out);
}

}  // namespace tessera::layers
