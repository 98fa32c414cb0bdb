#include "project/process/control_messages.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "../schema/judge.hpp"

namespace tessera::project {

using nlohmann::json;

TEST(ControlMessages, EveryCommandIsOneThatTheSchemaKnows) {
  for (const ControlCommand& one : std::vector<ControlCommand>{
           command::Recording{}, command::Own{}, command::Set{"v", "0.3"}, command::EmergencyStop{"smoke"},
           command::Panel{"robot.console.drive", "page 1", {{{"forward", 0.5}, {"horn", true}}}},
           command::Panel{"robot.console.drive", "page 1", {}}, command::EmergencyStop{}, command::Reset{},
           command::Pause{}, command::Resume{}, command::StepFiring{},
           command::StepIteration{"robot.control"}, command::Speed{2},
           command::Breakpoints{{"robot.in"}, {}, {"t_in"}}}) {
    schema_test::judge_command(json::parse(line_of(one)));
    const bool is_answered =
        !std::holds_alternative<command::Recording>(one) && !std::holds_alternative<command::Own>(one);
    if (is_answered) schema_test::judge_command(json::parse(line_of(one, 7)));
  }
  EXPECT_EQ(line_of(command::Pause{}, 7), "{\"command\":\"pause\",\"id\":7}\n");
}

TEST(ControlMessages, ASnapshotIsReadWholeAndPassedOnAsItCame) {
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
  EXPECT_EQ(snapshot.process, 4711);
  EXPECT_EQ(snapshot.emergency, "why");
  EXPECT_EQ(snapshot.recording, "/a.tsr");
  EXPECT_EQ(snapshot.control.value().pauses, 4U);
  EXPECT_EQ(snapshot.control.value().broke_at, "p");
  EXPECT_EQ(json_of(snapshot.subsystems), subsystems);
  EXPECT_EQ(json_of(snapshot.channels), channels);
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

}  // namespace tessera::project
