#include "layers/condition_truth.hpp"
#include "layers/sheet.hpp"
#include "spec/model/endings.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {
namespace {

using net::Condition;
using Truth = Condition::Truth;

Truth negation(Truth truth) {
  switch (truth) {
    case Truth::free:
      return Truth::free;
    case Truth::always:
      return Truth::never;
    case Truth::never:
      return Truth::always;
  }
  return Truth::free;
}

Truth conjunction(Truth a, Truth b) {
  if (a == Truth::never || b == Truth::never) return Truth::never;
  return a == Truth::always ? b : a;
}

std::string alternatives(const spec::Condition& condition) {
  std::string text;
  for (const spec::Expression& expression : condition.expressions) {
    if (!text.empty()) text += " or ";
    text += expression.name.empty() ? expression.text : expression.name;
  }
  return text;
}

/// Constants are not drawn, except that what never holds says so.
Condition condition(Condition::Kind kind, Truth truth, std::string free_text) {
  std::string text;
  if (truth == Truth::free) text = std::move(free_text);
  if (truth == Truth::never) text = "never";
  return {.kind = kind, .truth = truth, .text = std::move(text)};
}

/// The conditions of t4, t5 and t6, which exclude each other and of which one always holds.
struct Ending {
  Condition go_on, terminal, error;
};

Ending ending(const spec::Behaviour& behaviour) {
  const Truth terminal = truth(truth_of(behaviour.terminal));
  const Truth error = truth(truth_of(behaviour.error));
  const Truth no_error = negation(error);
  std::string go_on_text = error == Truth::free ? "no error" : "";
  if (terminal == Truth::free) go_on_text += go_on_text.empty() ? "not terminal" : ", not terminal";
  std::string terminal_text = terminal == Truth::free ? "terminal: " + alternatives(behaviour.terminal) : "";
  if (error == Truth::free) terminal_text += terminal_text.empty() ? "no error" : "; no error";
  Condition fails = condition(Condition::Kind::error, error, "error: " + alternatives(behaviour.error));
  if (error == Truth::never) {  // any behaviour ends by an exception, or the failure of a device
    fails.text = "failure";
    fails.set_with_failures({Truth::free, fails.exhaustive});
  }
  return {
      condition(Condition::Kind::go_on, conjunction(no_error, negation(terminal)), std::move(go_on_text)),
      condition(Condition::Kind::terminal, conjunction(no_error, terminal), std::move(terminal_text)),
      std::move(fails),
  };
}

}  // namespace

/// Layer 4, a behaviour (paper, sec. IV-D). The paper joins t5 and t6; apart, an error can be routed.
/// With `receive: first`, the same blocks stand in another order: the iteration begins (i := i + 1), receives,
/// calculates its transition function, and sends (docs/inside/decisions/0015-receive-first.md).
net::PageId draw_behaviour(Draft& draft, net::PageId parent, net::SubsystemId subsystem,
                           net::BehaviourId id) {
  using net::Operation;
  const spec::Subsystem& owner = draft.model.subsystem(subsystem);
  const spec::Behaviour& behaviour = owner.behaviours[id];
  Sheet sheet(draft, parent, net::Layer::behaviour, behaviour.name, subsystem, behaviour.span);
  sheet.drawn().behaviour = id;
  const auto communication = [&](Direction direction) {
    return sheet.page(draw_communication(draft, sheet.id(), subsystem, id, direction));
  };
  const Operation function{.kind = Operation::Kind::transition_function, .behaviour = id};
  const Operation count{.kind = Operation::Kind::next_iteration};
  const bool receives_first = owner.receive_first;
  const std::uint32_t in = sheet.input(receives_first ? count : function);
  const std::uint32_t early = communication(receives_first ? Direction::receive : Direction::send);
  const std::uint32_t step = sheet.place(words::step, receives_first ? function : count);
  const std::uint32_t late = communication(receives_first ? Direction::send : Direction::receive);
  const std::uint32_t out = sheet.output();

  auto [go_on, terminal, error] = ending(behaviour);
  const auto where = [&](const spec::Condition& given) {
    return given.kind == spec::Condition::Kind::never ? behaviour.span : given.span;
  };
  sheet.transition(words::first_step, {in}, {early}).role =
      receives_first ? Step::begin_receiving : Step::begin_sending;
  sheet.transition(words::second_step, {early}, {step}).role =
      receives_first ? Step::end_receiving : Step::end_sending;
  sheet.transition(words::third_step, {step}, {late}).role =
      receives_first ? Step::begin_sending : Step::begin_receiving;
  sheet.transition(words::go_on, {late}, {in}, std::move(go_on)).role = Step::go_on;
  net::PageTransition& ends = sheet.transition(words::terminal, {late}, {out}, std::move(terminal));
  ends.role = Step::terminal;
  ends.span = where(behaviour.terminal);
  net::PageTransition& fails = sheet.transition(words::error, {late}, {out}, std::move(error));
  fails.role = Step::error;
  fails.span = where(behaviour.error);
  return sheet.finish(in, out);
}

}  // namespace tessera::layers
