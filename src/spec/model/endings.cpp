#include "spec/model/endings.hpp"

#include <algorithm>
#include <utility>

namespace tessera::spec {

Truth truth_of(const Expression& expression) {
  if (expression.text == "true") return Truth::always;
  return expression.text == "false" ? Truth::never : Truth::free;
}

Truth truth_of(const Condition& condition) {
  return truth_of(condition, [](const Expression& expression) { return truth_of(expression); });
}

Truth truth_of(const Condition& condition, const TruthOf& known) {
  if (condition.kind == Condition::Kind::always) return Truth::always;
  if (condition.kind == Condition::Kind::never) return Truth::never;
  Truth any = Truth::never;
  for (const Expression& expression : condition.expressions) {
    const Truth one = known(expression);
    if (one == Truth::always) return Truth::always;
    if (one == Truth::free) any = Truth::free;
  }
  return any;
}

namespace {

/// The expressions of which one held when the behaviour ended. An entry that asks for one by name
/// excludes it for later entries.
class HeldExpressions {
 public:
  HeldExpressions(const std::vector<Expression>& expressions, const TruthOf& known) {
    for (const Expression& expression : expressions) truths_.push_back(known(expression));
  }

  Truth asked(ExpressionId expression) {
    const Truth truth = truths_[expression];
    const bool only = truth != Truth::never && std::ranges::count(truths_, Truth::never) + 1 ==
                                                   static_cast<std::ptrdiff_t>(truths_.size());
    truths_[expression] = Truth::never;
    return only ? Truth::always : truth;
  }

 private:
  Numbered<ExpressionId, Truth> truths_;
};

/// The truth of `when`, as far as it is known, if no earlier entry holds.
Truth truth_alone(const When& when, Ending ending, HeldExpressions& held, const TruthOf& known) {
  switch (when.kind) {
    case When::Kind::always:
      return Truth::always;
    case When::Kind::never:
      return Truth::never;
    case When::Kind::error:
      return ending == Ending::terminal ? Truth::never : Truth::always;
    case When::Kind::terminal:
      return ending == Ending::terminal ? held.asked(when.expression) : Truth::never;
    case When::Kind::named_error:
      return ending == Ending::error ? held.asked(when.expression) : Truth::never;
    case When::Kind::expression:  // a constant in quotes is an expression, whose truth nobody looks at
      return truth_of(when.text) == Truth::free ? known(when.text) : Truth::free;
  }
  return Truth::free;
}

/// The entry as which an error that no entry names is drawn; none: there is none yet.
NextId end_of(const Behaviour& behaviour) {
  const auto& next = behaviour.next;
  if (!next.empty() && next.back().implied) return {static_cast<std::uint32_t>(next.size() - 1)};
  for (const NextId entry : next.ids())
    if (next[entry].when.kind == When::Kind::always)
      return next[entry].behaviour.valid() || !next[entry].sets.empty() ? NextId{} : entry;
  return {};
}

}  // namespace

bool names_error(const Next& entry) {
  return entry.when.kind == When::Kind::error || entry.when.kind == When::Kind::named_error;
}

void complete_next(Behaviour& behaviour) {
  const Endings endings(behaviour);
  if (!endings.none_possible(Ending::error) && !endings.none_possible(Ending::failure)) return;
  Next end{.behaviour = {}, .when = {}, .span = behaviour.span, .implied = true};
  end.when.kind = When::Kind::error;
  behaviour.next.push_back(std::move(end));
}

Endings::Endings(const Behaviour& behaviour)
    : Endings(behaviour, [](const Expression& expression) { return truth_of(expression); }) {}

Truth allows_some(const Next& entry) { return entry.may_be_blocked ? Truth::free : Truth::always; }

Endings::Endings(const Behaviour& behaviour, TruthOf known, Allows allows)
    : behaviour_(behaviour), known_(std::move(known)), allows_(std::move(allows)) {
  for (const Ending ending : all_endings) try_entries(ending);
}

bool Endings::possible(Ending ending) const {
  switch (ending) {
    case Ending::terminal:
      return truth_of(behaviour_.error, known_) != Truth::always &&
             truth_of(behaviour_.terminal, known_) != Truth::never;
    case Ending::error:
      return truth_of(behaviour_.error, known_) != Truth::never;
    case Ending::failure:
      return !behaviour_.is_group() || behaviour_.group->may_fail;
  }
  return true;
}

bool Endings::asks(NextId entry, Ending ending) const {
  const Next& next = behaviour_.next[entry];
  return ending == Ending::terminal || (names_error(next) && !next.implied);
}

void Endings::try_entries(Ending ending) {
  auto& taken = taken_[at(ending)];
  taken.assign(behaviour_.next.size(), Truth::never);
  if (!possible(ending)) return;
  HeldExpressions held((ending == Ending::terminal ? behaviour_.terminal : behaviour_.error).expressions,
                       known_);
  Truth earlier = Truth::never;
  for (const NextId entry : behaviour_.next.ids()) {
    if (earlier == Truth::always) break;
    if (!asks(entry, ending)) continue;
    const Next& next = behaviour_.next[entry];
    const Truth allowed = allows_(next);
    HeldExpressions unasked = held;  // nothing follows from an entry that was not possible
    Truth alone = truth_alone(next.when, ending, allowed == Truth::always ? held : unasked, known_);
    if (allowed == Truth::never || (allowed == Truth::free && alone == Truth::always)) alone = allowed;
    taken[entry] = alone == Truth::always ? (earlier == Truth::never ? Truth::always : Truth::free) : alone;
    if (alone != Truth::never) earlier = alone;
  }
  none_[at(ending)] = earlier != Truth::always;
  if (earlier == Truth::always || ending == Ending::terminal) return;
  unrouted_[at(ending)] = true;
  const NextId end = end_of(behaviour_);
  if (!end.valid()) return;
  taken[end] = earlier == Truth::never ? Truth::always : Truth::free;
  none_[at(ending)] = false;
}

bool Endings::can_be_taken(NextId entry) const {
  return std::ranges::any_of(all_endings,
                             [&](Ending ending) { return taken(entry, ending) != Truth::never; });
}

}  // namespace tessera::spec
