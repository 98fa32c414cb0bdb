#include "spec/model/endings.hpp"

#include <algorithm>

namespace tessera::spec {

Truth truth_of(const Expression& expression) {
  if (expression.text == "true") return Truth::always;
  return expression.text == "false" ? Truth::never : Truth::free;
}

Truth truth_of(const Condition& condition) {
  if (condition.kind == Condition::Kind::always) return Truth::always;
  if (condition.kind == Condition::Kind::never) return Truth::never;
  Truth any = Truth::never;
  for (const Expression& expression : condition.expressions) {
    const Truth one = truth_of(expression);
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
  explicit HeldExpressions(const std::vector<Expression>& expressions) {
    for (const Expression& expression : expressions) truths_.push_back(truth_of(expression));
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
Truth truth_alone(const When& when, Ending ending, HeldExpressions& held) {
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
    case When::Kind::expression:
      return Truth::free;
  }
  return Truth::free;
}

}  // namespace

Endings::Endings(const Behaviour& behaviour) : behaviour_(behaviour) {
  for (const Ending ending : all_endings) try_entries(ending);
}

bool Endings::possible(Ending ending) const {
  switch (ending) {
    case Ending::terminal:
      return truth_of(behaviour_.error) != Truth::always && truth_of(behaviour_.terminal) != Truth::never;
    case Ending::error:
      return truth_of(behaviour_.error) != Truth::never;
    case Ending::failure:
      return true;
  }
  return true;
}

void Endings::try_entries(Ending ending) {
  auto& taken = taken_[at(ending)];
  taken.assign(behaviour_.next.size(), Truth::never);
  if (!possible(ending)) return;
  HeldExpressions held((ending == Ending::terminal ? behaviour_.terminal : behaviour_.error).expressions);
  Truth earlier = Truth::never;
  for (std::size_t entry = 0; entry < taken.size() && earlier != Truth::always; ++entry) {
    const Truth alone = truth_alone(behaviour_.next[entry].when, ending, held);
    taken[entry] = alone == Truth::always ? (earlier == Truth::never ? Truth::always : Truth::free) : alone;
    if (alone != Truth::never) earlier = alone;
  }
  none_[at(ending)] = earlier != Truth::always;
}

bool Endings::can_be_taken(NextId entry) const {
  return std::ranges::any_of(all_endings,
                             [&](Ending ending) { return taken(entry, ending) != Truth::never; });
}

}  // namespace tessera::spec
