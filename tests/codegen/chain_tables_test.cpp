// The chains in the tables of a controller, with what is proved of their times.
#include <gtest/gtest.h>

#include <string>

#include "generated.hpp"

namespace tessera::test {
namespace {

/// The line follower of docs/theory/timing.md.
std::string follower(const std::string& takes, const std::string& count = {}, const std::string& index = {}) {
  const std::string robot = "robot" + index;
  return "tessera: 1\nsystem: demo\nagents:\n  robot:\n" + count +
         "    control: { rate: 20 Hz, inputs: { line: float64 }, outputs: { motion: float64 },\n"
         "      behaviours: { follow: { takes: 2..8 ms, next: follow } } }\n"
         "    receptors: { sensor: { rate: 50 Hz, outputs: { line: float64 },\n"
         "      behaviours: { look: { " +
         takes +
         "next: look } } } }\n"
         "    effectors: { motor: { rate: 50 Hz, inputs: { motion: float64 },\n"
         "      behaviours: { drive: { takes: 1..2 ms, next: drive } } } }\n"
         "channels:\n  - \"" +
         robot + ".sensor.line -> " + robot + ".control.line\"\n  - { from: \"" + robot +
         ".control.motion\", to: \"" + robot + ".motor.motion\", receive: blocking, timeout: 200 ms }\n";
}

std::string system_of(const std::string& specification) { return generate(specification)["system.cpp"]; }

TEST(ChainTables, HoldTheProvedTimes) {
  const std::string text = system_of(follower("takes: 1..2 ms, "));
  EXPECT_NE(text.find("{\"robot.sensor -> robot.control -> robot.motor\", 82ms, 142ms},"), std::string::npos)
      << text;
  EXPECT_NE(text.find("{0, {0, 1}},"), std::string::npos) << text;
  EXPECT_NE(text.find(".chains = chains, .chain_ways = chain_ways"), std::string::npos);
}

TEST(ChainTables, AChainWithoutABoundIsMeasuredAllTheSame) {
  const std::string text = system_of(follower(""));
  EXPECT_NE(text.find("{\"robot.sensor -> robot.control -> robot.motor\"},"), std::string::npos) << text;
}

TEST(ChainTables, TheMembersOfAFleetShareARow) {
  const std::string text = system_of(follower("takes: 1..2 ms, ", "    count: 3\n", "[i]"));
  EXPECT_NE(text.find("chains[] = {\n    {\"robot[].sensor -> robot[].control -> robot[].motor\", 82ms, "
                      "142ms},\n};\n"),
            std::string::npos)
      << text;
  for (const char* end : {"}, 0},\n", "}, 1},\n", "}, 2},\n"})
    EXPECT_NE(text.find(end, text.find("chain_ways[]")), std::string::npos) << end;
}

TEST(ChainTables, ASpecificationThatSaysNoTimesHasNone) {
  const std::string text = read_file(line_follower_spec);
  ASSERT_EQ(text.find("takes"), std::string::npos);
  EXPECT_EQ(system_of(text).find("tessera::Chain"), std::string::npos);
}

}  // namespace
}  // namespace tessera::test
