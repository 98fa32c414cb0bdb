#include "watch/monitor_protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace tessera::testing {
namespace {

template <class Kind>
[[nodiscard]] const Kind* answered(const Request& request) {
  const auto* const command = std::get_if<AnsweredCommand>(&request.command);
  return command == nullptr ? nullptr : std::get_if<Kind>(command);
}

template <class Kind>
[[nodiscard]] const Kind* simulation(const Request& request) {
  const auto* const command = answered<SimulationCommand>(request);
  return command == nullptr ? nullptr : std::get_if<Kind>(command);
}

TEST(MonitorProtocol, ReadsCommandsWithTheirMembers) {
  const Request set = parse_request(R"({"id":7,"command":"set","path":"gain","value":"2"})");
  EXPECT_EQ(set.id, 7);
  ASSERT_NE(answered<commands::SetParameter>(set), nullptr);
  EXPECT_EQ(answered<commands::SetParameter>(set)->path, "gain");
  EXPECT_EQ(answered<commands::SetParameter>(set)->value, "2");

  const Request stop = parse_request(R"({"command":"emergency_stop"})");
  ASSERT_NE(answered<commands::EmergencyStop>(stop), nullptr);
  EXPECT_EQ(answered<commands::EmergencyStop>(stop)->why, "an operator asks for it");

  const Request scene = parse_request(R"({"command":"scene","from":7})");
  ASSERT_TRUE(std::holds_alternative<commands::SendScene>(scene.command));
  EXPECT_EQ(std::get<commands::SendScene>(scene.command).from, 7u);

  const Request breakpoints =
      parse_request(R"({"command":"breakpoints","places":["a","b",3],"transitions":"t"})");
  const auto* const wanted = simulation<commands::SetBreakpoints>(breakpoints);
  ASSERT_NE(wanted, nullptr);
  EXPECT_EQ(wanted->places, (std::vector<std::string>{"a", "b", ""}));
  EXPECT_EQ(wanted->transitions, std::vector<std::string>{"t"});
  EXPECT_TRUE(wanted->conditions.empty());

  const Request speed = parse_request(R"({"command":"speed","value":0.5})");
  ASSERT_NE(simulation<commands::SetSpeed>(speed), nullptr);
  EXPECT_EQ(simulation<commands::SetSpeed>(speed)->value, 0.5);
  EXPECT_FALSE(simulation<commands::SetSpeed>(parse_request(R"({"command":"speed","value":"1"})"))->value);

  EXPECT_TRUE(std::holds_alternative<commands::SendRecording>(
      parse_request(R"({"command":"recording","id":"x"})").command));
  EXPECT_TRUE(std::holds_alternative<commands::Own>(parse_request(R"({"command":"own"})").command));
}

TEST(MonitorProtocol, KeepsTheIdOfACommandThatMakesNoSense) {
  const Request set = parse_request(R"({"id":3,"command":"set","path":"gain","value":2})");
  EXPECT_EQ(set.id, 3);
  EXPECT_NE(answered<commands::Malformed>(set), nullptr);
  const Request flies = parse_request(R"({"id":4,"command":"fly"})");
  EXPECT_EQ(flies.id, 4);
  EXPECT_NE(simulation<commands::Unknown>(flies), nullptr);
  for (const char* text :
       {"", "{", "[]", "null", "\xff", R"({"command":3})", R"({"id":"1","command":"pause"})"})
    EXPECT_NE(answered<commands::Malformed>(parse_request(text)), nullptr) << text;
}

TEST(MonitorProtocol, ReadsWhatIsNestedDeeplyWithoutADeepStack) {
  constexpr std::size_t depth = 400'000;
  const std::string nested = std::string(depth, '[') + std::string(depth, ']');
  for (const char* before : {R"({"command":)", R"({"command":"breakpoints","places":)",
                             R"({"command":"speed","value":)", R"({"command":"pause","id":)"})
    static_cast<void>(parse_request(before + nested + "}"));
}

TEST(MonitorProtocol, WritesASnapshotInOneLine) {
  Snapshot snapshot;
  snapshot.system = "line";
  snapshot.pid = 12;
  snapshot.net_hash = "ab";
  snapshot.time_s = 1.5;
  Snapshot::Subsystem& subsystem = snapshot.subsystems.emplace_back();
  subsystem.path = "robot.a";
  subsystem.iterations = 2;
  snapshot.channels.push_back({.name = "x", .marked = {"full"}, .sending_since_s = {}});
  EXPECT_EQ(to_line(snapshot),
            R"({"channels":[{"marked":["full"],"name":"x"}],"net_hash":"ab","pid":12,"subsystems":[)"
            R"({"behaviour":null,"call_s":0.0,"called_at_s":0.0,"calling":false,"ended":false,"errors":0,)"
            R"("firings":0,"iterations":2,"longest_call_s":0.0,"overruns":0,"path":"robot.a",)"
            R"("period_s":0.0}],"system":"line","time_s":1.5,"waits":[]})"
            "\n");
  subsystem.memory = {{"count", "3"}, {"word", "\"a\xff\""}};
  EXPECT_NE(to_line(snapshot).find(
                "\"memory\":[{\"name\":\"count\",\"value\":\"3\"},{\"name\":\"word\",\"value\":"),
            std::string::npos)
      << to_line(snapshot);
  snapshot.recording = "r\xff";
  snapshot.simulation = {.paused = true, .pauses = 1, .speed = 0, .broke_at = ""};
  EXPECT_NE(to_line(snapshot).find(R"("paused":true,"pauses":1,"pid":12,"recording":"r)"), std::string::npos);
}

TEST(MonitorProtocol, AProcessOfADeploymentTellsItsLinksAndWhoWaits) {
  Snapshot snapshot;
  snapshot.channels.push_back({.name = "x", .marked = {"sent"}, .sending_since_s = 1.25});
  snapshot.waits.push_back({.subsystem = "robot.control",
                            .waits_for = "gate.control",
                            .channel = "x",
                            .for_answer = true,
                            .process = "gate",
                            .since_s = 1.25});
  snapshot.process = {.name = "robot", .host = "here", .incarnation = 18'446'744'073'709'551'615U};
  Snapshot::Link& link = snapshot.links.emplace_back();
  link.process = "gate";
  EXPECT_THAT(to_line(snapshot),
              ::testing::AllOf(::testing::HasSubstr(R"("sending_since_s":1.25)"),
                               ::testing::HasSubstr(R"("what":"answer")"),
                               ::testing::HasSubstr(R"("incarnation":"18446744073709551615")"),
                               ::testing::Not(::testing::HasSubstr("heard_s")),
                               ::testing::Not(::testing::HasSubstr("clock"))));
  link.heard_s = 2;
  link.clock_ahead_s = -0.5;
  EXPECT_THAT(to_line(snapshot), ::testing::AllOf(::testing::HasSubstr(R"("heard_s":2.0)"),
                                                  ::testing::HasSubstr(R"("clock_ahead_s":-0.5)"),
                                                  ::testing::HasSubstr(R"("clock_uncertainty_s":0.0)")));
}

TEST(MonitorProtocol, WritesAnswersAndPieces) {
  EXPECT_EQ(answer_line(3, Problem{"no"}), "{\"answer\":3,\"error\":\"no\"}\n");
  EXPECT_EQ(piece_line(5, true, false), "{\"begins\":true,\"more\":false,\"recording_bytes\":5}\n");
  EXPECT_EQ(ended_line(), "{\"ended\":true}\n");
}

}  // namespace
}  // namespace tessera::testing
