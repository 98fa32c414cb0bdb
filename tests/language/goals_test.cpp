// Memory with goals, in an editor.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "examples.hpp"
#include "language/edits/edit_json.hpp"
#include "language/edits/edits.hpp"

namespace tessera::language {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string patrol = R"(tessera: 1
system: s
types:
  Goal: { call: uint32, cancel: bool }
  Progress: { call: uint32, state: uint8 }
agents:
  robot:
    control:
      rate: 10 Hz
      inputs: { progress: Progress, wish: bool }
      outputs: { goal: Goal }
      memory: { going: { goal: out.goal, progress: in.progress }, station: { counts: 0..2 } }
      behaviours:
        go: { orders: going, cancel: on_leave, sets: { station: +1 }, terminal: memory.going == succeeded, next: rest }
        rest: { terminal: in.wish, next: go }
)";

std::string patrol_with(const std::string& old, const std::string& with) {
  std::string in = patrol;
  const std::size_t at = in.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? in : in.replace(at, old.size(), with);
}

std::vector<std::string> goal_proposals(const std::string& with_cursor) {
  const Typed typed(with_cursor);
  const Document document(typed.text, grammar());
  std::vector<std::string> labels;
  for (const Proposal& one : complete(document, typed.cursor)) labels.push_back(one.label);
  return labels;
}

std::string renamed_goal(const std::string& word, std::size_t skip, const std::string& name) {
  const Document document(patrol, grammar());
  const Renaming done = rename(document, nullptr, Lines(patrol).position(patrol.find(word) + skip), {}, name);
  return done.problem ? "refused: " + *done.problem : edited(document, done.edits);
}

TEST(GoalsInAnEditor, AreCompleted) {
  EXPECT_THAT(goal_proposals(patrol_with("orders: going", "orders: ‸")), ElementsAre("going"));
  EXPECT_THAT(goal_proposals(patrol_with("cancel: on_leave", "cancel: ‸")), ElementsAre("on_leave"));
  EXPECT_THAT(goal_proposals(patrol_with("goal: out.goal", "goal: ‸")), ElementsAre("goal"));
  EXPECT_THAT(goal_proposals(patrol_with("progress: in.progress", "progress: in.‸")),
              ElementsAre("progress", "wish"));
  EXPECT_THAT(goal_proposals(patrol_with("== succeeded", "== ‸")),
              ElementsAre("none", "accepted", "executing", "canceling", "succeeded", "canceled", "aborted",
                          "rejected", "gone", "ordered"));
  EXPECT_THAT(goal_proposals(patrol_with("{ station: +1 }", "{ ‸ }")), ElementsAre("station"));
  EXPECT_THAT(goal_proposals(patrol_with("orders: going, ", "‸ x: 1, ")), Contains("orders"));
}

TEST(GoalsInAnEditor, AreExplained) {
  const Document document(patrol, grammar());
  const auto found = explain(document, Lines(patrol).position(patrol.find("going: {")));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->markdown, HasSubstr("`{ goal: out.goal, progress: in.progress }`"));
  EXPECT_THAT(found->markdown, HasSubstr("In C++: `Memory::Going`"));
  EXPECT_THAT(found->markdown, HasSubstr("Changed on line 14."));
}

TEST(GoalsInAnEditor, AreRenamedWithTheirOrders) {
  const std::string cell = renamed_goal("going: {", 0, "travel");
  EXPECT_THAT(cell, HasSubstr("orders: travel, "));
  EXPECT_THAT(cell, HasSubstr("memory.travel == succeeded"));
  EXPECT_THAT(cell, Not(HasSubstr("going")));
  EXPECT_THAT(renamed_goal("goal: Goal", 0, "target"),
              HasSubstr("{ goal: out.target, progress: in.progress }"));
  EXPECT_THAT(renamed_goal("in.progress", 3, "told"), HasSubstr("progress: in.told }"));
  EXPECT_THAT(renamed_goal("in.progress", 3, "told"), HasSubstr("inputs: { told: Progress"));
}

TEST(GoalsInAnEditor, GoWithTheirOrders) {
  const auto edits = edits_of(nlohmann::ordered_json::parse(
      R"([{"do":"remove","at":["agents","robot","control","memory","going"]}])"));
  ASSERT_TRUE(edits);
  const Document document(patrol, grammar());
  const Renaming done = edit(document, *edits, {});
  ASSERT_FALSE(done.problem) << *done.problem;
  EXPECT_THAT(edited(document, done.edits), HasSubstr("go: { sets: { station: +1 }, terminal"));
}

}  // namespace
}  // namespace tessera::language
