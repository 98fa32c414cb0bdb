#include "layers/sheet.hpp"

namespace tessera::layers {
namespace {

using net::Condition;
using Truth = Condition::Truth;

std::string label(const spec::Expression& expression) {
  return expression.name.empty() ? expression.text : expression.name;
}

/// What is known of one entry's `when`, taken alone.
Truth truth_alone(const spec::When& when, const spec::Behaviour& behaviour) {
  if (when.kind == spec::When::Kind::always) return Truth::always;
  if (when.kind != spec::When::Kind::error) return Truth::free;
  switch (behaviour.error.kind) {
    case spec::Condition::Kind::never:
      return Truth::never;
    case spec::Condition::Kind::always:
      return Truth::always;
    case spec::Condition::Kind::expressions:
      return Truth::free;
  }
  return Truth::free;
}

std::string text_of(const spec::When& when, const spec::Behaviour& behaviour) {
  switch (when.kind) {
    case spec::When::Kind::always:
      return "otherwise";
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

/// The initial conditions of a behaviour's successors: of the entries of `next`, the first that holds is
/// taken, so an entry is certain only if it holds and all before it cannot.
std::vector<Condition> initial_conditions(const spec::Behaviour& behaviour) {
  if (behaviour.next.size() == 1 && behaviour.next.front().when.kind == spec::When::Kind::always) return {{}};
  std::vector<Condition> conditions;
  const bool exhaustive = spec::always_continues(behaviour);
  Truth earlier = Truth::never;
  for (spec::Index entry = 0; entry < behaviour.next.size(); ++entry) {
    const spec::When& when = behaviour.next[entry].when;
    const Truth alone = truth_alone(when, behaviour);
    Truth truth = alone;
    if (earlier == Truth::always) truth = Truth::never;
    if (earlier == Truth::free && alone == Truth::always) truth = Truth::free;
    if (alone == Truth::always || earlier == Truth::always)
      earlier = Truth::always;
    else if (alone == Truth::free)
      earlier = Truth::free;
    conditions.push_back({Condition::Kind::next, truth, entry, text_of(when, behaviour), exhaustive});
  }
  return conditions;
}

}  // namespace

/// Layer 3, a subsystem (paper, sec. IV-C): a graph of behaviours, of which one is active.
net::PageId draw_subsystem(Draft& draft, net::PageId parent, spec::Index instance) {
  const spec::Subsystem& subsystem = draft.model.subsystem(instance);
  Sheet sheet(draft, parent, net::Layer::subsystem, subsystem.name, instance, subsystem.span);
  const std::uint32_t in = sheet.place("in");
  std::vector<std::uint32_t> behaviours;
  for (spec::Index behaviour = 0; behaviour < subsystem.behaviours.size(); ++behaviour)
    behaviours.push_back(sheet.page(draw_behaviour(draft, sheet.id(), instance, behaviour)));
  const std::uint32_t out = sheet.place("out");

  sheet.transition("t_in", {in}, {behaviours[subsystem.start]});
  for (spec::Index index = 0; index < subsystem.behaviours.size(); ++index) {
    const spec::Behaviour& behaviour = subsystem.behaviours[index];
    const std::vector<Condition> conditions = initial_conditions(behaviour);
    for (spec::Index entry = 0; entry < behaviour.next.size(); ++entry) {
      const spec::Next& next = behaviour.next[entry];
      sheet.transition("t_" + behaviour.name + "_" + std::to_string(entry + 1), {behaviours[index]},
                       {next.behaviour == spec::none ? out : behaviours[next.behaviour]}, conditions[entry],
                       next.span);
    }
  }
  return sheet.finish(in, out);
}

}  // namespace tessera::layers
