#include "spec/model.hpp"

#include <gtest/gtest.h>

namespace tessera::spec {
namespace {

Next ask(When::Kind kind, Index expression = none) { return {none, {kind, expression, {}}, {}}; }

Behaviour ending(Condition::Kind terminal, std::size_t expressions, std::vector<Next> next) {
  Behaviour behaviour;
  behaviour.terminal.kind = terminal;
  behaviour.terminal.expressions.resize(expressions);
  behaviour.next = std::move(next);
  return behaviour;
}

TEST(AlwaysContinues, WithAnUnconditionalEntry) {
  EXPECT_TRUE(always_continues(ending(Condition::Kind::always, 0, {ask(When::Kind::always)})));
  EXPECT_FALSE(always_continues(ending(Condition::Kind::always, 0, {ask(When::Kind::error)})));
}

TEST(AlwaysContinues, WhenABehaviourThatOnlyFailsRoutesItsError) {
  EXPECT_TRUE(always_continues(ending(Condition::Kind::never, 0, {ask(When::Kind::error)})));
  EXPECT_FALSE(always_continues(ending(Condition::Kind::never, 0, {ask(When::Kind::named_error, 0)})));
}

TEST(AlwaysContinues, WhenErrorAndEveryTerminalExpressionAreAskedFor) {
  const auto both = Condition::Kind::expressions;
  EXPECT_TRUE(always_continues(
      ending(both, 2, {ask(When::Kind::terminal, 0), ask(When::Kind::terminal, 1), ask(When::Kind::error)})));
  EXPECT_FALSE(always_continues(ending(both, 2, {ask(When::Kind::terminal, 0), ask(When::Kind::error)})));
  EXPECT_FALSE(always_continues(ending(both, 1, {ask(When::Kind::terminal, 0)})));
  EXPECT_FALSE(always_continues(ending(both, 1, {ask(When::Kind::expression), ask(When::Kind::error)})));
}

}  // namespace
}  // namespace tessera::spec
