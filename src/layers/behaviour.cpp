#include "layers/condition_truth.hpp"
#include "layers/sheet.hpp"
#include "spec/model/endings.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {
namespace {

using net::Condition;
using Truth = Condition::Truth;

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

/// The knowledge about the conditions of a behaviour.
struct EndingTruths {
  Truth terminal, error;
  EndingTruths(const spec::Behaviour& behaviour, const spec::TruthOf& truths)
      : terminal(truth(truth_of(behaviour.terminal, truths))),
        error(truth(truth_of(behaviour.error, truths))) {}
  [[nodiscard]] Truth goes_on() const { return conjunction(negation(error), negation(terminal)); }
  [[nodiscard]] Truth ends() const { return conjunction(negation(error), terminal); }
};

/// failing: what is known if any iteration may end with a failure.
Ending ending(const spec::Behaviour& behaviour, EndingTruths known, EndingTruths failing) {
  std::string go_on_text = known.error == Truth::free ? "no error" : "";
  if (known.terminal == Truth::free) go_on_text += go_on_text.empty() ? "not terminal" : ", not terminal";
  std::string terminal_text =
      known.terminal == Truth::free ? "terminal: " + alternatives(behaviour.terminal) : "";
  if (known.error == Truth::free) terminal_text += terminal_text.empty() ? "no error" : "; no error";
  Condition fails = condition(Condition::Kind::error, known.error, "error: " + alternatives(behaviour.error));
  if (known.error == Truth::never) {  // any behaviour ends by an exception, or the failure of a device
    fails.text = "failure";
    fails.set_with_failures({Truth::free, fails.exhaustive});
  } else {
    fails.set_with_failures({failing.error, fails.exhaustive});
  }
  Ending all{condition(Condition::Kind::go_on, known.goes_on(), std::move(go_on_text)),
             condition(Condition::Kind::terminal, known.ends(), std::move(terminal_text)), std::move(fails)};
  all.go_on.set_with_failures({failing.goes_on(), all.go_on.exhaustive});
  all.terminal.set_with_failures({failing.ends(), all.terminal.exhaustive});
  return all;
}

KnownFacts::Expressions expressions_of_ending(const spec::Behaviour& behaviour) {
  KnownFacts::Expressions all;
  for (const spec::Condition* condition : {&behaviour.terminal, &behaviour.error})
    for (const spec::Expression& expression : condition->expressions) all.push_back(&expression);
  return all;
}

/// Draws the ends of an iteration. If its conditions ask for facts, each is drawn for the values with which it
/// can be the end, and at least once.
class EndingPen {
 public:
  EndingPen(Sheet& sheet, const KnownFacts& facts, const spec::Behaviour& behaviour, spec::BehaviourId id)
      : sheet_(sheet), facts_(facts), assignments_(facts.assignments(expressions_of_ending(behaviour), id)) {
    for (const KnownFacts::Values& values : assignments_)
      endings_.push_back(ending(behaviour, EndingTruths(behaviour, facts.truths(id, values, false)),
                                EndingTruths(behaviour, facts.truths(id, values, true))));
  }

  void draw(std::string_view name, Condition Ending::*which, Step role, std::uint32_t from, std::uint32_t to,
            net::Span span) const {
    bool drawn = false;
    for (std::size_t number = 0; number < assignments_.size(); ++number) {
      const bool possible = (endings_[number].*which).known(true).truth != Truth::never;
      const bool last = number + 1 == assignments_.size();
      if (!possible && !(last && !drawn)) continue;
      drawn = true;
      FactPen(sheet_, facts_)
          .draw(std::string(name), assignments_[number], {},
                [&](const std::string& full, const FactPen::Nodes& inputs, const FactPen::Nodes& outputs) {
                  FactPen::Nodes takes{from}, gives{to};
                  takes.insert(takes.end(), inputs.begin(), inputs.end());
                  gives.insert(gives.end(), outputs.begin(), outputs.end());
                  net::PageTransition& made =
                      sheet_.transition(full, std::move(takes), std::move(gives), endings_[number].*which);
                  made.role = role;
                  made.span = span;
                });
    }
  }

 private:
  Sheet& sheet_;
  const KnownFacts& facts_;
  std::vector<KnownFacts::Values> assignments_;
  std::vector<Ending> endings_;  // per assignment
};

}  // namespace

/// Layer 4, a behaviour (paper, sec. IV-D). The paper joins t5 and t6; apart, an error can be routed.
/// With `receive: first`, the same blocks stand in another order: the iteration begins (i := i + 1), receives,
/// calculates its transition function, and sends (docs/inside/decisions/0015-receive-first.md).
net::PageId draw_behaviour(Draft& draft, net::PageId parent, net::SubsystemId subsystem,
                           net::BehaviourId id) {
  using net::Operation;
  const spec::Subsystem& owner = draft.model.subsystem(subsystem);
  const spec::Behaviour& behaviour = owner.behaviours[id];
  Sheet sheet(draft, parent, net::Layer::behaviour, std::string(behaviour.label()), subsystem,
              behaviour.span);
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

  const auto where = [&](const spec::Condition& given) {
    return given.kind == spec::Condition::Kind::never ? behaviour.span : given.span;
  };
  sheet.transition(words::first_step, {in}, {early}).role =
      receives_first ? Step::begin_receiving : Step::begin_sending;
  sheet.transition(words::second_step, {early}, {step}).role =
      receives_first ? Step::end_receiving : Step::end_sending;
  sheet.transition(words::third_step, {step}, {late}).role =
      receives_first ? Step::begin_sending : Step::begin_receiving;
  const EndingPen ends(sheet, draft.facts[subsystem], behaviour, id);
  ends.draw(words::go_on, &Ending::go_on, Step::go_on, late, in, behaviour.span);
  ends.draw(words::terminal, &Ending::terminal, Step::terminal, late, out, where(behaviour.terminal));
  ends.draw(words::error, &Ending::error, Step::error, late, out, where(behaviour.error));
  return sheet.finish(in, out);
}

}  // namespace tessera::layers
