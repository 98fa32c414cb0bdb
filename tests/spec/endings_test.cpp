#include "spec/model/endings.hpp"

#include <gtest/gtest.h>

#include <string>

#include "verify_circuits/naive_endings.hpp"

namespace tessera::spec {
namespace {

Next ask(When::Kind kind, ExpressionId expression = {}) { return {{}, {kind, expression, {}}, {}}; }

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
  const Endings endings(behaviour);
  EXPECT_FALSE(endings.possible(Ending::terminal));
  EXPECT_EQ(endings.taken({0}, Ending::error), Truth::free);
  EXPECT_EQ(endings.taken({1}, Ending::error), Truth::free);
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
  EXPECT_EQ(endings.taken({2}, Ending::failure), Truth::always);
}

}  // namespace
}  // namespace tessera::spec
