#include "tessera/control_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "../schema/judge.hpp"

namespace tessera {

using nlohmann::json;

namespace {

template <class Kind>
const Kind* command_of(const ControlRequest& request) {
  return request.command ? std::get_if<Kind>(&*request.command) : nullptr;
}

template <class Kind>
const Kind* simulation_command_of(const ControlRequest& request) {
  const auto* const command = command_of<SimulationCommand>(request);
  return command == nullptr ? nullptr : std::get_if<Kind>(command);
}

/// A snapshot with every member of the messages.
Snapshot whole_snapshot() {
  Snapshot snapshot{.system = "arm", .net_hash = "abc"};
  snapshot.pid = 12;
  snapshot.time_s = 1.5;
  snapshot.recording = "/a.tsr";
  snapshot.emergency = "why";
  snapshot.process = "robot";
  snapshot.host = "here";
  snapshot.incarnation = "18446744073709551615";
  snapshot.subsystems.push_back({.path = "robot.a", .behaviour = "go", .memory = {{"count", "3"}}});
  snapshot.channels.push_back({.name = "x", .marked = {"sent"}, .sending_since_s = 1.25});
  snapshot.waits.push_back({.subsystem = "robot.a",
                            .waits_for = "gate.b",
                            .channel = "x",
                            .for_answer = true,
                            .process = "gate",
                            .since_s = 1.25});
  snapshot.links.push_back({.process = "gate", .host = "there", .heard_s = 2, .clock_ahead_s = -0.5});
  snapshot.deployment = {.domain = 3, .interface = "eth0", .peers = {"p"}, .processes = {{"robot", "here"}}};
  return snapshot;
}

}  // namespace

TEST(ControlMessages, EveryCommandIsOneThatTheSchemaKnows) {
  for (const ControlCommand& one : std::vector<ControlCommand>{
           command::Recording{}, command::Scene{}, command::Scene{7}, command::Own{},
           command::Set{"v", "0.3"}, command::EmergencyStop{"smoke"},
           command::Panel{"robot.console.drive", "page 1", {{{"forward", 0.5}, {"horn", true}}}},
           command::Panel{"robot.console.drive", "page 1", {}}, command::Offers{}, command::EmergencyStop{},
           command::Reset{}, command::Pause{}, command::Resume{}, command::StepFiring{},
           command::StepIteration{"robot.control"}, command::Speed{2},
           command::Breakpoints{{"robot.in"}, {}, {"t_in"}}}) {
    schema_test::judge_command(json::parse(line_of(one)));
    const ControlRequest read = read_control_request(line_of(one, 7));
    ASSERT_TRUE(read.command) << line_of(one);
    EXPECT_EQ(line_of(*read.command, read.id), line_of(one, 7));
    const bool is_answered = !std::holds_alternative<command::Recording>(one) &&
                             !std::holds_alternative<command::Scene>(one) &&
                             !std::holds_alternative<command::Own>(one);
    if (is_answered) schema_test::judge_command(json::parse(line_of(one, 7)));
  }
  EXPECT_EQ(line_of(command::Pause{}, 7), "{\"command\":\"pause\",\"id\":7}\n");
}

TEST(ControlMessages, ASnapshotIsReadWholeAndWrittenAsItCame) {
  const json subsystems{{{"path", "robot.control"},
                         {"behaviour", nullptr},
                         {"calling", true},
                         {"ended", false},
                         {"iterations", 3},
                         {"firings", 20},
                         {"overruns", 1},
                         {"errors", 2},
                         {"period_s", 0.05},
                         {"called_at_s", 1.5},
                         {"call_s", 0.001},
                         {"longest_call_s", 0.002}}};
  const json channels{{{"name", "a->b"}, {"marked", {"full"}}}};
  json line{{"system", "arm"},       {"pid", 4711},          {"net_hash", "abc"},
            {"time_s", 2.5},         {"emergency", "why"},   {"recording", "/a.tsr"},
            {"paused", true},        {"pauses", 4},          {"speed", 0.1},
            {"broke_at", "p"},       {"channels", channels}, {"subsystems", subsystems},
            {"waits", json::array()}};
  schema_test::judge_line(line);
  line["of_a_newer_version"] = 1;
  const std::optional<ControlLine> read = read_control_line(line.dump());
  ASSERT_TRUE(read && std::holds_alternative<Snapshot>(*read));
  const auto& snapshot = std::get<Snapshot>(*read);
  EXPECT_EQ(snapshot.pid, 4711);
  EXPECT_EQ(snapshot.emergency, "why");
  EXPECT_EQ(snapshot.recording, "/a.tsr");
  EXPECT_EQ(snapshot.control.value().pauses, 4U);
  EXPECT_EQ(snapshot.control.value().broke_at, "p");
  line.erase("of_a_newer_version");
  EXPECT_EQ(json::parse(line_of(snapshot)), line);
}

TEST(ControlMessages, MemoryIsReadWithItsSubsystem) {
  const auto read = [](const json& memory) {
    json subsystem{{"path", "robot.control"}};
    subsystem["memory"] = memory;
    json line{{"system", "arm"}};
    line["subsystems"].push_back(subsystem);
    return read_control_line(line.dump());
  };
  json fields = json::array();
  fields.push_back({{"name", "free"}, {"value", "0.35"}});
  fields.push_back({{"name", "at"}, {"value", "{yaw: 1}"}, {"of_a_newer_version", 1}});
  const std::optional<ControlLine> line = read(fields);
  ASSERT_TRUE(line && std::holds_alternative<Snapshot>(*line));
  const auto& memory = std::get<Snapshot>(*line).subsystems.at(0).memory;
  ASSERT_EQ(memory.size(), 2U);
  EXPECT_EQ(memory[1].name, "at");
  EXPECT_EQ(memory[1].value, "{yaw: 1}");
  for (const json& wrong : {json(3), json("a"), json::parse("[3]"), json::parse(R"([{"name":3}])")})
    EXPECT_FALSE(read(wrong)) << wrong;
}

TEST(ControlMessages, EveryLineIsWhatItsMembersSay) {
  const auto is = [](const auto& wanted, const char* line) {
    schema_test::judge_line(json::parse(line));
    const std::optional<ControlLine> read = read_control_line(line);
    return read && read->index() == ControlLine(wanted).index();
  };
  EXPECT_TRUE(is(CommandAnswer{}, R"({"answer": 3, "error": "no"})"));
  EXPECT_TRUE(is(PieceHead{}, R"({"recording_bytes": 12, "begins": true, "more": false})"));
  EXPECT_TRUE(is(ControllerHasEnded{}, R"({"ended": true})"));
  EXPECT_EQ(std::get<PieceHead>(read_control_line(R"({"recording_bytes": 12})").value()).bytes, 12U);
  EXPECT_FALSE(std::get<Snapshot>(read_control_line(R"({"system": "old"})").value()).control);
}

TEST(ControlMessages, NonsenseIsNoLine) {
  for (const char* line : {"", "[]", "3", "\xff", R"({"time_s": "soon"})", R"({"subsystems": 3})",
                           R"({"subsystems": [3]})", R"({"answer": "yes"})", R"({"ended": true)"})
    EXPECT_FALSE(read_control_line(line)) << line;
}

TEST(ControlMessages, TheClientReadsEveryMemberThatTheControllerWrites) {
  Snapshot snapshot = whole_snapshot();
  const auto round = [](const Snapshot& one) {
    schema_test::judge_line(json::parse(line_of(one)));
    return line_of(std::get<Snapshot>(read_control_line(line_of(one)).value()));
  };
  EXPECT_EQ(round(snapshot), line_of(snapshot));
  snapshot.process.reset();
  snapshot.host = snapshot.incarnation = "";
  snapshot.links.clear();
  snapshot.deployment.reset();
  snapshot.control = {.paused = true, .pauses = 1, .speed = 0.5, .broke_at = "p"};
  EXPECT_EQ(round(snapshot), line_of(snapshot));
  const Offered offered{
      {{"a.b.v", "[1, 2]", "m", 0, 3}, {"a.b.w", "x", "", {}, {}}},
      {{"a.eye.x", 0.5, true, {{"ahead", "1", "m/s", -1, 1}, {"horn", "true", "", {}, {}}}}}};
  schema_test::judge_line(json::parse(line_of(CommandAnswer{3, {}, false, offered})));
  for (const CommandAnswer& one : {CommandAnswer{3, Problem{"no"}, true}, CommandAnswer{4, {}, false},
                                   CommandAnswer{5, {}, false, offered}})
    EXPECT_EQ(line_of(std::get<CommandAnswer>(read_control_line(line_of(one)).value())), line_of(one));
  const SceneHead scene{.bytes = 3, .from = 4, .total = 9};
  EXPECT_EQ(line_of(std::get<SceneHead>(read_control_line(line_of(scene)).value())), line_of(scene));
}

TEST(ControlMessages, ReadsCommandsWithTheirMembers) {
  const ControlRequest set = read_control_request(R"({"id":7,"command":"set","path":"gain","value":"2"})");
  EXPECT_EQ(set.id, 7);
  ASSERT_NE(command_of<command::Set>(set), nullptr);
  EXPECT_EQ(command_of<command::Set>(set)->path, "gain");
  EXPECT_EQ(command_of<command::Set>(set)->value, "2");

  const ControlRequest stop = read_control_request(R"({"command":"emergency_stop"})");
  ASSERT_NE(command_of<command::EmergencyStop>(stop), nullptr);
  EXPECT_EQ(command_of<command::EmergencyStop>(stop)->why, "");

  const ControlRequest scene = read_control_request(R"({"command":"scene","from":7})");
  ASSERT_NE(command_of<command::Scene>(scene), nullptr);
  EXPECT_EQ(command_of<command::Scene>(scene)->from, 7u);

  const ControlRequest breakpoints =
      read_control_request(R"({"command":"breakpoints","places":["a","b"],"transitions":["t"]})");
  const auto* const wanted = simulation_command_of<command::Breakpoints>(breakpoints);
  ASSERT_NE(wanted, nullptr);
  EXPECT_EQ(wanted->places, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(wanted->transitions, std::vector<std::string>{"t"});
  EXPECT_TRUE(wanted->conditions.empty());

  const ControlRequest speed = read_control_request(R"({"command":"speed","value":0.5})");
  ASSERT_NE(simulation_command_of<command::Speed>(speed), nullptr);
  EXPECT_EQ(simulation_command_of<command::Speed>(speed)->value, 0.5);
}

TEST(ControlMessages, KeepsTheIdOfACommandThatMakesNoSense) {
  for (const char* text :
       {R"({"id":3,"command":"set","path":"gain","value":2})", R"({"id":3,"command":"set","path":"gain"})",
        R"({"id":3,"command":"speed","value":"1"})", R"({"id":3,"command":"scene","from":"here"})",
        R"({"id":3,"command":"breakpoints","places":["a",3]})",
        R"({"id":3,"command":"panel","path":"p","values":{"a":"b"}})"}) {
    const ControlRequest wrong = read_control_request(text);
    EXPECT_EQ(wrong.id, 3) << text;
    EXPECT_EQ(wrong.command.problem(), "this is no command") << text;
  }
  const ControlRequest flies = read_control_request(R"({"id":4,"command":"fly"})");
  EXPECT_EQ(flies.id, 4);
  EXPECT_EQ(flies.command.problem(), "there is no such command");
  for (const char* text :
       {"", "{", "[]", "null", "\xff", "{}", R"({"command":3})", R"({"id":"1","command":"pause"})"})
    EXPECT_EQ(read_control_request(text).command.problem(), "this is no command") << text;
}

TEST(ControlMessages, ReadsWhatIsNestedDeeplyWithoutADeepStack) {
  constexpr std::size_t depth = 400'000;
  const std::string nested = std::string(depth, '[') + std::string(depth, ']');
  for (const char* before : {R"({"command":)", R"({"command":"breakpoints","places":)",
                             R"({"command":"speed","value":)", R"({"command":"pause","id":)"})
    static_cast<void>(read_control_request(before + nested + "}"));
}

TEST(ControlMessages, WritesASnapshotInOneLine) {
  Snapshot snapshot;
  snapshot.system = "line";
  snapshot.pid = 12;
  snapshot.net_hash = "ab";
  snapshot.time_s = 1.5;
  Snapshot::Subsystem& subsystem = snapshot.subsystems.emplace_back();
  subsystem.path = "robot.a";
  subsystem.iterations = 2;
  snapshot.channels.push_back({.name = "x", .marked = {"full"}, .sending_since_s = {}});
  EXPECT_EQ(line_of(snapshot),
            R"({"channels":[{"marked":["full"],"name":"x"}],"net_hash":"ab","pid":12,"subsystems":[)"
            R"({"behaviour":null,"call_s":0.0,"called_at_s":0.0,"calling":false,"ended":false,"errors":0,)"
            R"("firings":0,"iterations":2,"longest_call_s":0.0,"overruns":0,"path":"robot.a",)"
            R"("period_s":0.0}],"system":"line","time_s":1.5,"waits":[]})"
            "\n");
  subsystem.memory = {{"count", "3"}, {"word", "\"a\xff\""}};
  EXPECT_NE(line_of(snapshot).find(
                "\"memory\":[{\"name\":\"count\",\"value\":\"3\"},{\"name\":\"word\",\"value\":"),
            std::string::npos)
      << line_of(snapshot);
  snapshot.recording = "r\xff";
  snapshot.control = {.paused = true, .pauses = 1, .speed = 0, .broke_at = ""};
  EXPECT_NE(line_of(snapshot).find(R"("paused":true,"pauses":1,"pid":12,"recording":"r)"), std::string::npos);
}

TEST(ControlMessages, AProcessOfADeploymentTellsItsLinksAndWhoWaits) {
  Snapshot snapshot;
  snapshot.channels.push_back({.name = "x", .marked = {"sent"}, .sending_since_s = 1.25});
  snapshot.waits.push_back({.subsystem = "robot.control",
                            .waits_for = "gate.control",
                            .channel = "x",
                            .for_answer = true,
                            .process = "gate",
                            .since_s = 1.25});
  snapshot.process = "robot";
  snapshot.incarnation = "18446744073709551615";
  Snapshot::Link& link = snapshot.links.emplace_back();
  link.process = "gate";
  EXPECT_THAT(line_of(snapshot),
              ::testing::AllOf(::testing::HasSubstr(R"("sending_since_s":1.25)"),
                               ::testing::HasSubstr(R"("what":"answer")"),
                               ::testing::HasSubstr(R"("incarnation":"18446744073709551615")"),
                               ::testing::Not(::testing::HasSubstr("heard_s")),
                               ::testing::Not(::testing::HasSubstr("clock"))));
  link.heard_s = 2;
  link.clock_ahead_s = -0.5;
  EXPECT_THAT(line_of(snapshot), ::testing::AllOf(::testing::HasSubstr(R"("heard_s":2.0)"),
                                                  ::testing::HasSubstr(R"("clock_ahead_s":-0.5)")));
}

TEST(ControlMessages, WritesAnswersAndPieces) {
  EXPECT_EQ(line_of(CommandAnswer{3, Problem{"no"}, false}), "{\"answer\":3,\"error\":\"no\"}\n");
  EXPECT_EQ(line_of(PieceHead{5, true, false}), "{\"begins\":true,\"more\":false,\"recording_bytes\":5}\n");
  EXPECT_EQ(line_of(ControllerHasEnded{}), "{\"ended\":true}\n");
}

}  // namespace tessera
