#include <gtest/gtest.h>

#include "layers/models.hpp"
#include "spec/model/endings.hpp"

namespace tessera::test {
namespace {

using Kind = spec::Condition::Kind;
using Truth = net::Condition::Truth;
using When = spec::When::Kind;

spec::Condition given(Kind kind, const char* name = "") {
  spec::Condition condition;
  condition.kind = kind;
  if (kind == Kind::expressions) condition.expressions.push_back({name, "in.x.level < 3", {}});
  return condition;
}

net::Page page_of(const spec::Behaviour& behaviour, const char* path) {
  ModelBuilder builder;
  builder.agent("a", {subsystem(spec::SubsystemKind::control, "c", {}, {}, {behaviour})});
  const Built built = build(builder.result());
  return built.pages.pages[built.pages.find(path).value];
}

struct EndingCase {
  Kind terminal, error;
  Truth go_on, ends, fails;
  const char *go_on_text, *ends_text, *fails_text;
};

constexpr auto never = Kind::never;
constexpr auto always = Kind::always;
constexpr auto some = Kind::expressions;

// t4, t5, t6: they exclude each other and one always holds.
const std::vector<EndingCase> ending_cases{
    {never, never, Truth::always, Truth::never, Truth::never, "", "never", "failure"},
    {always, never, Truth::never, Truth::always, Truth::never, "never", "", "failure"},
    {some, never, Truth::free, Truth::free, Truth::never, "not terminal", "terminal: done", "failure"},
    {never, some, Truth::free, Truth::never, Truth::free, "no error", "never", "error: in.x.level < 3"},
    {always, some, Truth::never, Truth::free, Truth::free, "never", "no error", "error: in.x.level < 3"},
    {some, some, Truth::free, Truth::free, Truth::free, "no error, not terminal", "terminal: done; no error",
     "error: in.x.level < 3"},
    {never, always, Truth::never, Truth::never, Truth::always, "never", "never", ""},
    {always, always, Truth::never, Truth::never, Truth::always, "never", "never", ""},
    {some, always, Truth::never, Truth::never, Truth::always, "never", "never", ""},
};

TEST(Conditions, OfABehavioursEndFollowFromItsConstants) {
  for (const EndingCase& expected : ending_cases) {
    SCOPED_TRACE(testing::Message() << "terminal " << int(expected.terminal) << ", error "
                                    << int(expected.error));
    spec::Behaviour work = behaviour("work");
    work.terminal = given(expected.terminal, "done");
    work.error = given(expected.error);
    const net::Page page = page_of(work, "a.c.work");
    ASSERT_EQ(page.transitions.size(), 6U);
    const net::Condition &t4 = page.transitions[3].condition, &t5 = page.transitions[4].condition,
                         &t6 = page.transitions[5].condition;
    EXPECT_EQ(t4.kind, net::Condition::Kind::go_on);
    EXPECT_EQ(t5.kind, net::Condition::Kind::terminal);
    EXPECT_EQ(t6.kind, net::Condition::Kind::error);
    EXPECT_EQ(t4.truth, expected.go_on);
    EXPECT_EQ(t5.truth, expected.ends);
    EXPECT_EQ(t6.truth, expected.fails);
    EXPECT_EQ(t4.text, expected.go_on_text);
    EXPECT_EQ(t5.text, expected.ends_text);
    EXPECT_EQ(t6.text, expected.fails_text);
    EXPECT_NE(t6.known(true).truth, Truth::never) << "any behaviour may end by a failure";
    EXPECT_EQ(t4.known(true).truth, expected.go_on);
    EXPECT_EQ(t5.known(true).truth, expected.ends);
  }
}

spec::Next entry(When kind) {
  spec::Next next;
  next.when.kind = kind;
  next.when.expression = {0};
  next.when.text = {"", "memory.n > 7", {}};
  return next;
}

std::string truths(const spec::Behaviour& behaviour, bool failures = false) {
  const net::Page page = page_of(behaviour, "a.c");
  std::string text;
  for (std::size_t at = 1; at < page.transitions.size(); ++at) {
    const net::Condition& condition = page.transitions[at].condition;
    const char* names[] = {"free", "always", "never"};
    text += (at > 1 ? ", " : "") + condition.text + " " + names[int(condition.known(failures).truth)];
  }
  return text;
}

TEST(Conditions, OfNextAreTriedInOrder) {
  spec::Behaviour work = behaviour("work");
  work.terminal = given(some, "done");
  work.error = given(some, "lost");
  work.next = {entry(When::terminal), entry(When::named_error), entry(When::expression), entry(When::always)};
  // The one terminal condition held, so the entries behind it are never taken.
  EXPECT_EQ(truths(work), "done free, lost free, memory.n > 7 never, otherwise never");
  EXPECT_EQ(truths(work, true), "done free, lost free, memory.n > 7 never, otherwise free") << "it is `end`";
  work.next = {entry(When::error), entry(When::always), entry(When::expression)};
  EXPECT_EQ(truths(work), "error free, otherwise free, memory.n > 7 never");
  work.error = given(never);
  EXPECT_EQ(truths(work), "error never, otherwise always, memory.n > 7 never");
  EXPECT_EQ(truths(work, true), "error free, otherwise free, memory.n > 7 never");
  work.error = given(always);
  EXPECT_EQ(truths(work), "error always, otherwise never, memory.n > 7 never");
}

TEST(Conditions, OfAnEntryThatNamesNoErrorExcludeFailures) {
  spec::Behaviour work = behaviour("work");
  work.terminal = given(some, "done");
  work.next = {entry(When::always)};
  work.next[0].behaviour = {0};
  spec::complete_next(work);
  EXPECT_EQ(truths(work), "no error always, error never");
  EXPECT_EQ(truths(work, true), "no error free, error free");
  work.error = given(some, "lost");
  EXPECT_EQ(truths(work), "no error free, error free");
}

TEST(Conditions, OfOneUnconditionalNextAreNone) {
  const net::Page page = page_of(behaviour("work"), "a.c");
  EXPECT_EQ(page.transitions[1].condition, net::Condition{});
}

}  // namespace
}  // namespace tessera::test
