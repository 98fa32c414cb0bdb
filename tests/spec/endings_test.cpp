#include "spec/model/endings.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "verify_circuits/naive_endings.hpp"

namespace tessera::spec {
namespace {

Next ask(When::Kind kind, ExpressionId expression = {}) {
  return {.behaviour = {}, .when = {.kind = kind, .expression = expression}, .span = {}};
}

Condition given(Condition::Kind kind, const std::vector<const char*>& expressions = {}) {
  Condition condition;
  condition.kind = kind;
  for (const char* text : expressions)
    condition.expressions.push_back({"n" + std::to_string(condition.expressions.size()), text, {}});
  return condition;
}

Truth truth(const std::set<int>& taken, int entry) {
  if (!taken.contains(entry)) return Truth::never;
  return taken.size() == 1 ? Truth::always : Truth::free;
}

TEST(Endings, SayWhatTheControllerDoesForAllValuesOfAllExpressions) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Behaviour behaviour;
    test::draw_endings(behaviour, 3, seed);
    const Endings endings(behaviour);
    const test::NaiveEndings tried = test::try_endings(behaviour);
    for (const Ending ending : all_endings) {
      SCOPED_TRACE("ending " + std::to_string(static_cast<int>(ending)));
      ASSERT_EQ(endings.possible(ending), tried.ends(ending));
      ASSERT_EQ(endings.none_possible(ending), tried.after(ending).contains(-1));
      for (const NextId entry : behaviour.next.ids())
        ASSERT_EQ(endings.taken(entry, ending), truth(tried.after(ending), static_cast<int>(entry.value)))
            << entry.value;
    }
  }
}

TEST(Endings, OfAConstantErrorAreNeverTerminal) {
  Behaviour behaviour;
  behaviour.error = given(Condition::Kind::always);
  behaviour.terminal = given(Condition::Kind::always);
  behaviour.next = {ask(When::Kind::expression), ask(When::Kind::error), ask(When::Kind::always)};
  complete_next(behaviour);
  ASSERT_EQ(behaviour.next.size(), 3U) << "an entry takes every error";
  const Endings endings(behaviour);
  EXPECT_FALSE(endings.possible(Ending::terminal));
  EXPECT_EQ(endings.taken({0}, Ending::error), Truth::never);
  EXPECT_EQ(endings.taken({1}, Ending::error), Truth::always);
  EXPECT_FALSE(endings.can_be_taken({2}));
  EXPECT_FALSE(endings.none_possible(Ending::error));
}

TEST(Endings, AskedForByNameOneAfterTheOtherLeaveTheLastForCertain) {
  Behaviour behaviour;
  behaviour.terminal = given(Condition::Kind::expressions, {"memory.a", "memory.b"});
  behaviour.next = {ask(When::Kind::terminal, {0}), ask(When::Kind::terminal, {1}), ask(When::Kind::always)};
  const Endings endings(behaviour);
  EXPECT_EQ(endings.taken({1}, Ending::terminal), Truth::free);
  EXPECT_EQ(endings.taken({2}, Ending::terminal), Truth::never);
}

/// The text of a `next`, and the entries that a failure and an error condition take.
struct Route {
  const char* says;
  std::vector<Next> next;
  std::uint32_t failure, error;  ///< numbers of entries
  bool implied;                  ///< an entry is added
};

TEST(Endings, WithAnErrorAskForAnEntryThatNamesIt) {
  const BehaviourId x{1};
  const auto to = [&](BehaviourId behaviour, When::Kind kind, ExpressionId expression = {}) {
    Next next = ask(kind, expression);
    next.behaviour = behaviour;
    return next;
  };
  using Kind = When::Kind;
  const std::vector<Route> routes{
      {"x", {to(x, Kind::always)}, 1, 1, true},
      {"end", {to({}, Kind::always)}, 0, 0, false},
      {"[{ to: x, when: expression }]", {to(x, Kind::expression)}, 1, 1, true},
      {"[{ to: end, when: expression }, x]", {to({}, Kind::expression), to(x, Kind::always)}, 2, 2, true},
      {"[{ to: x, when: done }]", {to(x, Kind::terminal, {0})}, 1, 1, true},
      {"[x, { to: x, when: error }]", {to(x, Kind::always), to(x, Kind::error)}, 1, 1, false},
      {"[end, { to: x, when: error }]", {to({}, Kind::always), to(x, Kind::error)}, 1, 1, false},
      {"[{ to: x, when: lost }, x]", {to(x, Kind::named_error, {0}), to(x, Kind::always)}, 2, 0, true},
      {"[{ to: x, when: lost }, end]", {to(x, Kind::named_error, {0}), to({}, Kind::always)}, 1, 0, false},
      {"[{ to: x, when: lost }, { to: end, when: error }]",
       {to(x, Kind::named_error, {0}), to({}, Kind::error)},
       1,
       0,
       false},
  };
  for (const Route& route : routes) {
    SCOPED_TRACE(route.says);
    Behaviour behaviour;
    behaviour.terminal = given(Condition::Kind::expressions, {"memory.done"});
    behaviour.error = given(Condition::Kind::expressions, {"memory.lost"});
    behaviour.next = route.next;
    complete_next(behaviour);
    EXPECT_EQ(behaviour.next.back().implied, route.implied);
    const Endings endings(behaviour);
    EXPECT_EQ(endings.taken({route.failure}, Ending::failure), Truth::always);
    EXPECT_EQ(endings.taken({route.error}, Ending::error), Truth::always);
    EXPECT_FALSE(endings.none_possible(Ending::error) || endings.none_possible(Ending::failure));
  }
}

TEST(Endings, ThatAreUnroutedAreThoseThatNoWrittenEntryNames) {
  Behaviour behaviour;
  behaviour.error = given(Condition::Kind::expressions, {"memory.a", "memory.b"});
  behaviour.next = {ask(When::Kind::named_error, {0}), ask(When::Kind::always)};
  complete_next(behaviour);
  EXPECT_TRUE(Endings(behaviour).unrouted(Ending::error)) << "the second error";
  behaviour.next = {ask(When::Kind::named_error, {0}), ask(When::Kind::named_error, {1})};
  complete_next(behaviour);
  EXPECT_FALSE(Endings(behaviour).unrouted(Ending::error));
  EXPECT_TRUE(Endings(behaviour).unrouted(Ending::failure)) << "has no name but `error`";
  behaviour.next = {ask(When::Kind::error)};
  complete_next(behaviour);
  EXPECT_FALSE(Endings(behaviour).unrouted(Ending::failure));
}

}  // namespace
}  // namespace tessera::spec
