// Runs through groups of behaviours: each entry of a group follows a way out of it that it asks for.
#include <gtest/gtest.h>

#include "net/token_game.hpp"
#include "proved.hpp"

namespace tessera::verify {
namespace {

std::string grouped(const std::string& inner, const std::string& next) {
  return R"(tessera: 1
system: s
agents:
  robot:
    control:
      rate: 10 Hz
      behaviours:
        work: { terminal: true, next: charge }
        charge:
          next: )" +
         next + R"(
          behaviours:
            dock:
              next: end
              behaviours:
                )" +
         inner + R"(
        safe: { next: { to: safe, when: error } }
properties:
  - { name: never safe, never: robot.control.safe }
)";
}

using ConditionKind = net::Condition::Kind;

/// The last ending before `safe`, and whether each entry of the groups follows what left them.
struct Way {
  ConditionKind ending = ConditionKind::none;
  std::size_t entries = 0;
  bool fits = true;
};

Way way_to_safe(const Proved& all) {
  const PropertyResult& found = all["never safe"];
  EXPECT_EQ(found.verdict, Verdict::violated);
  Way way;
  net::Condition last{};
  for (const net::TransitionId id : found.trace) {
    const net::Condition& now = all.net[id].condition;
    if (now.kind != ConditionKind::next && now.kind != ConditionKind::terminal &&
        now.kind != ConditionKind::error)
      continue;
    if (now.kind == ConditionKind::next) {
      ++way.entries;
      const bool terminal =
          last.kind == ConditionKind::terminal || (last.kind == ConditionKind::next && last.follows.terminal);
      const bool error =
          last.kind == ConditionKind::error || (last.kind == ConditionKind::next && last.follows.error);
      way.fits = way.fits && ((terminal && now.follows.terminal) || (error && now.follows.error));
    } else {
      way.ending = now.kind;
    }
    last = now;
  }
  return way;
}

TEST(GroupRuns, AFailureLeavesAllGroupsBeforeAnEntryThatNamesIt) {
  const Way way =
      way_to_safe(proved(grouped("turn: { terminal: elapsed > 2 s, error: elapsed > 1 s, next: end }",
                                 "[{ to: safe, when: error }, work]")));
  EXPECT_EQ(way.ending, ConditionKind::error);
  EXPECT_EQ(way.entries, 4U);  // work, turn, dock, charge
  EXPECT_TRUE(way.fits);
}

TEST(GroupRuns, ATerminalEndingLeavesAllGroupsBeforeOtherEntries) {
  const Way way =
      way_to_safe(proved(grouped("turn: { terminal: elapsed > 2 s, error: elapsed > 1 s, next: end }",
                                 "[{ to: work, when: error }, safe]")));
  EXPECT_EQ(way.ending, ConditionKind::terminal);
  EXPECT_EQ(way.entries, 4U);
  EXPECT_TRUE(way.fits);
}

/// The groups of `work` take their failures themselves, unless `next` of the inner behaviour says otherwise.
std::string caught(const std::string& next) {
  return R"(tessera: 1
system: s
agents:
  robot:
    control:
      rate: 10 Hz
      inputs: { wish: bool }
      memory: { pause: bool, done: bool }
      behaviours:
        charge:
          until: memory.pause
          on_error: wait
          behaviours:
            dock:
              behaviours:
                turn: { terminal: memory.done, next: )" +
         next + R"( }
            wait: { terminal: true, next: [{ to: wait, when: error }, dock] }
          next: charge
  desk: { control: { rate: 10 Hz, outputs: { wish: bool }, behaviours: { run: {} } } }
channels:
  - { from: desk.control.wish, to: robot.control.wish, send: blocking }
)";
}

TEST(GroupRuns, FailuresThatAreTakenInAGroupDoNotLeaveIt) {
  for (const char* next : {"end", "[{ to: turn, when: error }, end]"})
    EXPECT_EQ(proved(caught(next))["survives_exceptions"].verdict, Verdict::holds) << next;
  std::string lost = caught("end");
  lost.replace(lost.find("[{ to: wait, when: error }, dock]"), 33, "dock");
  EXPECT_EQ(proved(lost)["survives_exceptions"].verdict, Verdict::violated);
}

}  // namespace
}  // namespace tessera::verify
