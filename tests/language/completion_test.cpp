#include <gmock/gmock.h>

#include "examples.hpp"

namespace tessera::language {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;

std::vector<std::string> proposed(const std::string& with_cursor) {
  const Typed typed(with_cursor);
  const Document document(typed.text, grammar());
  std::vector<std::string> labels;
  for (const Proposal& one : complete(document, typed.cursor)) labels.push_back(one.label);
  return labels;
}

const std::string head = R"(tessera: 1
system: follower
types:
  LineReading: { left: bool, right: bool }
  Velocity: { linear: float64 m/s, angular: float64 rad/s }
parameters: { v: 0.2 m/s }
templates:
  walker:
    control:
      inputs: { line: LineReading, order: bool }
      outputs: { motion: Velocity }
      memory: { count: uint32 }
      behaviours:
        init: { terminal: { ready: true }, next: follow }
        follow: {}
    receptors:
      sensor:
        real: { light: "float64[3]" }
        outputs: { line: LineReading }
        behaviours: { watch: {} }
agents:
  robot: { use: walker, count: 3 }
  boss: { use: walker }
)";

/// The head with other behaviours of the control subsystem.
std::string with_behaviour(const std::string& line) {
  std::string text = head;
  const std::string old = "        follow: {}\n";
  return text.replace(text.find(old), old.size(), "        follow: " + line + "\n");
}

TEST(Completion, KeysOfTheSchemaWithoutThoseThatAreThere) {
  EXPECT_THAT(proposed(head + "‸"),
              AllOf(IsSupersetOf({"channels", "drivers", "simulation"}), Not(Contains("types"))));
  EXPECT_THAT(proposed(with_behaviour("{ ‸ }")),
              IsSupersetOf({"terminal", "error", "next", "send", "takes"}));
  EXPECT_THAT(proposed(with_behaviour("\n          te‸")), Contains("terminal"));
  EXPECT_THAT(proposed(head + "channels:\n  - { fr‸"), IsSupersetOf({"from", "to", "receive"}));
}

TEST(Completion, WordsOfTheSchema) {
  EXPECT_THAT(proposed(head + "channels:\n  - { from: a, receive: ‸"),
              ElementsAre("blocking", "blocking_once", "non_blocking"));
  EXPECT_THAT(proposed(with_behaviour("{ transfer: ‸ }")), ElementsAre("sequential", "parallel"));
  EXPECT_THAT(proposed(with_behaviour("{}\n      receive: ‸")), ElementsAre("last", "first"));
}

TEST(Completion, BehavioursAndTheirConditions) {
  EXPECT_THAT(proposed(with_behaviour("{ next: ‸ }")), ElementsAre("init", "follow", "end"));
  EXPECT_THAT(proposed(with_behaviour("{ next: [{ to: fo‸ }] }")), Contains("follow"));
  EXPECT_THAT(
      proposed(with_behaviour("{ terminal: { lost: true, done: true }, next: [{ to: init, when: ‸ }] }")),
      IsSupersetOf({"lost", "done", "error", "in"}));
}

TEST(Completion, NamesInConditions) {
  EXPECT_THAT(proposed(with_behaviour("{ terminal: ‸ }")),
              IsSupersetOf({"in", "out", "memory", "parameters", "true"}));
  EXPECT_THAT(proposed(with_behaviour("{ terminal: in.‸ }")), ElementsAre("line", "order"));
  EXPECT_THAT(proposed(with_behaviour("{ terminal: \"!in.line.‸\" }")),
              IsSupersetOf({"left", "right", "fresh", "age"}));
  EXPECT_THAT(proposed(with_behaviour("{ error: { lost: memory.count > 3 && out.motion.li‸ } }")),
              Contains("linear"));
  EXPECT_THAT(proposed(with_behaviour("{ terminal: parameters.‸ }")), ElementsAre("v"));
}

TEST(Completion, TypesBuffersTemplates) {
  EXPECT_THAT(proposed(head + "  a: { control: { inputs: { x: ‸ } } }"),
              IsSupersetOf({"LineReading", "float64"}));
  EXPECT_THAT(proposed(head + "  a: { use: ‸ }"), ElementsAre("walker"));
  EXPECT_THAT(proposed(with_behaviour("{ send: [‸] }")), ElementsAre("motion"));
  EXPECT_THAT(proposed(with_behaviour("{ receive: [line, ‸] }")), ElementsAre("line", "order"));
}

TEST(Completion, EndsOfChannels) {
  EXPECT_THAT(proposed(head + "channels:\n  - ‸"),
              IsSupersetOf({"boss.control.motion", "robot[i].sensor.line", "from"}));
  EXPECT_THAT(proposed(head + "channels:\n  - boss.sensor.line -> boss.control.‸"),
              ElementsAre("line", "order"));
  EXPECT_THAT(proposed(head + "channels:\n  - { from: boss.sensor.‸"), ElementsAre("line"));
  EXPECT_THAT(proposed(head + "channels:\n  - { from: boss.‸"), ElementsAre("control", "sensor"));
}

TEST(Completion, PathsOfDriversAndProperties) {
  EXPECT_THAT(proposed(head + "drivers:\n  ‸"), IsSupersetOf({"boss.sensor.light", "robot[*].sensor.light"}));
  EXPECT_THAT(proposed(head + "properties:\n  - { never: \"boss.control.‸\" }"),
              IsSupersetOf({"init", "follow"}));
  EXPECT_THAT(proposed(head + "deploy:\n  processes:\n    one: [‸]"), ElementsAre("boss", "robot[*]"));
}

TEST(Completion, ChainsOfTiming) {
  const std::string chains = head + "timing:\n  latency: 1 us\n  chains:\n";
  EXPECT_THAT(proposed(head + "timing:\n  ‸"), ElementsAre("chains", "latency", "network"));
  EXPECT_THAT(proposed(chains + "    - { ‸"), ElementsAre("name", "path", "age", "reaction"));
  EXPECT_THAT(proposed(chains + "    - { path: [‸] }"),
              IsSupersetOf({"boss.sensor", "boss.control", "robot[i].control"}));
  EXPECT_THAT(proposed(chains + "    - { path: [boss.sensor, boss.‸] }"), ElementsAre("control", "sensor"));
  EXPECT_THAT(proposed(chains + "    - { path: [boss.sensor, boss.control.‸] }"),
              IsSupersetOf({"line", "motion"}));
  EXPECT_THAT(proposed(chains + "    - { age: ‸ }"), Contains("200 ms"));
}

TEST(Completion, NamesThatAreStillEmptyAreNotOffered) {
  std::string text = head + "properties:\n  - never: robot.‸\n";
  const std::string named = "      sensor:";
  text.replace(text.find(named), named.size(), "      \"\":");
  EXPECT_THAT(proposed(text), AllOf(Contains("control"), Not(Contains(""))));
}

TEST(Completion, ReplacesTheWordAndQuotesBracketsInBraces) {
  const Typed typed(head + "channels:\n  - { from: ro‸b }");
  const Document document(typed.text, grammar());
  const std::vector<Proposal> all = complete(document, typed.cursor);
  const auto found = std::find_if(all.begin(), all.end(),
                                  [](const Proposal& one) { return one.label == "robot[i].sensor.line"; });
  ASSERT_NE(found, all.end());
  EXPECT_EQ(found->insert, "\"robot[i].sensor.line\"");
  EXPECT_EQ(found->range.start.character, typed.cursor.character - 2);
  EXPECT_EQ(found->range.end.character, typed.cursor.character + 1);
}

TEST(Completion, NothingInComments) { EXPECT_THAT(proposed(head + "# see chan‸"), IsEmpty()); }

TEST(Hover, TellsTypesConditionsAndWhatAKeyMeans) {
  const auto says = [](const std::string& with_cursor) {
    const Typed typed(with_cursor);
    const Document document(typed.text, grammar());
    const auto found = explain(document, typed.cursor);
    return found ? found->markdown : "";
  };
  EXPECT_THAT(says(with_behaviour("{ terminal: in.li‸ne.left }")), ::testing::HasSubstr("LineReading"));
  EXPECT_THAT(says(with_behaviour("{ terminal: out.motion.lin‸ear > 1 }")),
              ::testing::HasSubstr("float64 m/s"));
  EXPECT_THAT(says(with_behaviour("{ trans‸fer: parallel }")), ::testing::HasSubstr("all at once"));
  EXPECT_THAT(says(with_behaviour("{ next: in‸it }")), ::testing::HasSubstr("walker.control.init"));
}

}  // namespace
}  // namespace tessera::language
