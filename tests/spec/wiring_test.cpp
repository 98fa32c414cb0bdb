#include <gmock/gmock.h>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

using testing::HasSubstr;

/// Two agents; the body of the first one's control subsystem and the channels vary.
std::string two_agents(const std::string& control, const std::string& channels) {
  return "tessera: 1\nsystem: demo\nagents:\n  a:\n    control: " + control +
         "\n  b:\n    control: { rate: 1 Hz, outputs: { x: bool }, behaviours: { run: {} } }\nchannels:\n" +
         channels;
}

TEST(Time, PassesByRateBlockingReceiveBlockingSendOrDeclaration) {
  const std::string plain = "  - b.control.x -> a.control.x\n";
  const std::string receive = "  - { from: b.control.x, to: a.control.x, receive: blocking }\n";
  EXPECT_EQ(Reading(two_agents("{ inputs: { x: bool }, behaviours: { run: {} } }", plain)).codes(), "E305");
  EXPECT_EQ(
      Reading(two_agents("{ rate: 1 Hz, inputs: { x: bool }, behaviours: { run: {} } }", plain)).codes(), "");
  EXPECT_EQ(
      Reading(two_agents("{ inputs: { x: bool }, behaviours: { run: { takes: 1 ms } } }", plain)).codes(),
      "");
  EXPECT_EQ(Reading(two_agents("{ inputs: { x: bool }, behaviours: { run: {} } }", receive)).codes(), "");
}

TEST(Time, AOneShotBehaviourNeedsNoWait) {
  const std::string receive = "  - { from: b.control.x, to: a.control.x, receive: blocking }\n";
  EXPECT_EQ(Reading(two_agents("{ inputs: { x: bool }, behaviours: { init: { receive: [], terminal: true, "
                               "next: run }, run: {} } }",
                               receive))
                .codes(),
            "");
}

TEST(Units, AreComparedOnlyWhereBothAreGiven) {
  const auto codes = [](const std::string& from, const std::string& to) {
    return Reading(
               "tessera: 1\nsystem: demo\nagents:\n"
               "  a: { control: { rate: 1 Hz, outputs: { x: " +
               from +
               " }, behaviours: { run: {} } } }\n"
               "  b: { control: { rate: 1 Hz, inputs: { y: " +
               to +
               " }, behaviours: { run: {} } } }\n"
               "channels: [a.control.x -> b.control.y]\n")
        .codes();
  };
  EXPECT_EQ(codes("float64 m", "float64 m"), "");
  EXPECT_EQ(codes("float64 m", "float64"), "");
  EXPECT_EQ(codes("float64 m", "float64 mm"), "E208");
  EXPECT_EQ(codes("float64 m", "float32 m"), "E207");
  EXPECT_EQ(codes("string<=8", "string<=9"), "E207");
}

TEST(Warnings, DoNotRejectASpecification) {
  const Reading reading(
      two_agents("{ rate: 1 Hz, outputs: { y: bool }, behaviours: { run: {}, lonely: {} } }", "  []\n"));
  EXPECT_TRUE(reading.model.has_value());
  EXPECT_EQ(reading.codes(), "W311 W316 W316");
}

TEST(Warnings, AConditionThatAsksAnInputThatItsBehaviourNeverReceives) {
  const auto codes = [](const std::string& behaviour) {
    return Reading(
               "tessera: 1\nsystem: demo\nagents:\n"
               "  a: { control: { rate: 1 Hz, outputs: { x: bool }, behaviours: { run: {} } } }\n"
               "  b: { control: { rate: 1 Hz, inputs: { y: bool }, memory: { n: bool }, behaviours: {\n"
               "    all: { terminal: in.y, next: one },\n    one: { " +
               behaviour + " } } } }\nchannels: [a.control.x -> b.control.y]\n")
        .codes();
  };
  EXPECT_EQ(codes("receive: [], terminal: in.y.fresh, next: all"), "W371");
  EXPECT_EQ(codes("receive: [], terminal: in.y, next: all"), "W371");
  EXPECT_EQ(codes("receive: [], error: { late: in.y.timed_out }"), "W313 W371")
      << "no entry asks for it, too";
  EXPECT_EQ(codes("receive: [], terminal: true, next: [{ to: all, when: in.y.fresh }, end]"), "W371");
  EXPECT_EQ(codes("receive: [y], terminal: in.y.fresh, next: all"), "");
  EXPECT_EQ(codes("terminal: in.y.fresh, next: all"), "");
  // The age goes on, and `next` may choose by the value that an earlier behaviour has received.
  EXPECT_EQ(codes("receive: [], terminal: in.y.age > 2 s, next: all"), "");
  EXPECT_EQ(codes("receive: [], terminal: true, next: [{ to: all, when: in.y }, end]"), "");
  EXPECT_EQ(codes("receive: [], terminal: memory.n && in.y, next: all"), "");
}

TEST(Warnings, AStaleThatIsShorterThanTheWaitsBeforeIt) {
  const auto codes = [](const std::string& behaviour, const std::string& timeout) {
    return Reading(
               "tessera: 1\nsystem: demo\nagents:\n"
               "  dock: { control: { rate: 1 Hz, outputs: { x: bool }, behaviours: { run: {} } } }\n"
               "  a:\n    control: { inputs: { y: bool }, outputs: { m: float64 }, behaviours: {\n"
               "      drive: { " +
               behaviour +
               " }, wait: { send: [], terminal: true, next: drive } } }\n"
               "    effectors: { base: { rate: 1 Hz, inputs: { m: float64 }, real: { w: float64 }, stale: "
               "500 ms, "
               "behaviours: { run: {} } } }\n"
               "channels:\n  - { from: dock.control.x, to: a.control.y, receive: blocking" +
               timeout + " }\n  - a.control.m -> a.base.m\n")
        .codes();
  };
  EXPECT_EQ(codes("terminal: in.y, next: wait", ", timeout: 1 s"), "W372");
  EXPECT_EQ(codes("terminal: in.y, next: wait", ", timeout: 500 ms"), "");
  EXPECT_EQ(codes("terminal: in.y, next: wait", ""), "") << "it waits for ever, as is meant";
  EXPECT_EQ(codes("terminal: true, next: wait", ", timeout: 1 s"), "") << "it does not repeat";
  EXPECT_EQ(codes("send: [], terminal: in.y, next: wait", ", timeout: 1 s"), "W317")
      << "it sends nothing there";
}

TEST(Warnings, AMistakeThatAgentsShareIsReportedOnce) {
  const Reading reading(
      "tessera: 1\nsystem: demo\ntemplates:\n  t: { control: { rate: 1 Hz, inputs: { x: bool }, behaviours: "
      "{ run: {} } } }\n"
      "agents: { robot: { use: t, count: 1000 } }\n");
  EXPECT_EQ(reading.codes(), "E302");
  EXPECT_THAT(reading.report(),
              HasSubstr("input 'x' of robot[0].control (and of 999 more agents) has no source"));
}

TEST(Fleet, OfOneAgentHasNoNeighbours) {
  const Reading reading(
      "tessera: 1\nsystem: demo\ntemplates:\n"
      "  t: { control: { rate: 1 Hz, inputs: { x: bool }, outputs: { y: bool }, behaviours: { run: {} } } }\n"
      "agents: { robot: { use: t, count: 1 } }\nchannels: [\"robot[i].control.y -> "
      "robot[i+1].control.x\"]\n");
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_TRUE(reading.model->channels.empty());
}

}  // namespace
}  // namespace tessera::spec
