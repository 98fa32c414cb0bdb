#include "run/command_line.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "nets.hpp"
#include "run/driver_requests.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// Exit code of a controller with those arguments.
int control(TestSystem& system, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "controller");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return controller_main(system.system(), static_cast<int>(argv.size()), argv.data());
}

struct CommandLineOf : ::testing::Test {
  TestSystem system;
  Script script;
  double gain = 0;
  CommandLineOf() {
    script.call = [this](ScriptState& state) { gain = state.gain; };
    system.add("robot.a", nets::alone, script, 10ms);
  }
};

TEST_F(CommandLineOf, SimulateRunsAndSummarises) {
  const std::string summary = scratch_file("summary.json");
  const std::string recording = scratch_file("run");
  EXPECT_EQ(control(system, {"simulate", "--for", "2s", "--set", "robot.a.gain=3", "--summary", summary,
                             "--record", recording}),
            0);
  EXPECT_EQ(gain, 3);
  const auto json = nlohmann::json::parse(file_bytes(summary));
  EXPECT_EQ(json.at("simulated_s"), 2.0);
  EXPECT_EQ(json.at("ended"), "duration");
  EXPECT_EQ(json.at("failed"), false);
  EXPECT_EQ(json.at("recording"), recording);
  EXPECT_EQ(json.at("subsystems").at(0).at("path"), "robot.a");
  EXPECT_EQ(json.at("subsystems").at(0).at("iterations"), 200);
  EXPECT_GT(json.at("real_time_factor"), 0);
}

TEST_F(CommandLineOf, ParameterFileComesBeforeSet) {
  const std::string file = scratch_file("params");
  std::ofstream(file) << "gain = 2\n";
  EXPECT_EQ(control(system, {"simulate", "--for", "10ms", "--parameters", file}), 0);
  EXPECT_EQ(gain, 2);
  EXPECT_EQ(control(system, {"simulate", "--for", "10ms", "--set", "gain=4", "--parameters", file}), 0);
  EXPECT_EQ(gain, 4);
}

TEST_F(CommandLineOf, ConfigFileHoldsOptions) {
  const std::string file = scratch_file("config.toml");
  std::ofstream(file) << "[simulate]\nfor = \"10ms\"\nset = [\"gain=5\"]\n";
  EXPECT_EQ(control(system, {"--config", file, "simulate"}), 0);
  EXPECT_EQ(gain, 5);
}

TEST_F(CommandLineOf, WrongUsageIsTwo) {
  EXPECT_EQ(control(system, {}), 2);
  EXPECT_EQ(control(system, {"fly"}), 2);
  EXPECT_EQ(control(system, {"simulate", "--for", "soon"}), 2);
  EXPECT_EQ(control(system, {"simulate", "--set", "gain"}), 2);
  EXPECT_EQ(control(system, {"simulate", "--driver", "robot.a.x"}), 2);
  EXPECT_EQ(control(system, {"simulate", "--nonsense"}), 2);
  EXPECT_EQ(control(system, {"run", "--realtime"}), 2);
}

TEST_F(CommandLineOf, WhatCannotStartIsOne) {
  EXPECT_EQ(control(system, {"simulate", "--for", "1s", "--set", "unknown=1"}), 1);
  EXPECT_EQ(control(system, {"simulate", "--for", "1s", "--parameters", "/nonexistent"}), 1);
  EXPECT_EQ(control(system, {"simulate", "--for", "1s", "--record", "/nonexistent/run"}), 1);
  EXPECT_EQ(control(system, {"simulate", "--for", "10ms", "--summary", "/nonexistent/summary"}), 1);
}

TEST_F(CommandLineOf, ArgumentsOfRos2GoToTheEndOrToTwoDashes) {
  std::vector<std::string> words{"controller", "--ros-args", "-r",         "a:=b", "--",    "run",
                                 "--for",      "1s",         "--ros-args", "-p",   "x:=--y"};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  const auto parsed = parse_command_line(system.system(), static_cast<int>(argv.size()), argv.data());
  ASSERT_TRUE(std::holds_alternative<CommandLine>(parsed));
  const RunOptions& options = std::get<CommandLine>(parsed).options;
  EXPECT_EQ(options.ros2_arguments, (std::vector<std::string>{"-r", "a:=b", "-p", "x:=--y"}));
  EXPECT_EQ(options.duration, Duration(1s));
  EXPECT_EQ(control(system, {"simulate", "--for", "1s", "--ros-args"}), 2);
  EXPECT_EQ(control(system, {"run", "--for", "1s", "-r", "a:=b"}), 2);
}

TEST_F(CommandLineOf, HelpIsZero) { EXPECT_EQ(control(system, {"simulate", "--help"}), 0); }

TEST(CommandLine, FailedRunIsOne) {
  TestSystem system;
  Script script;
  script.decide = [](const ScriptState&) { return Outcome::error; };
  system.add("robot.a", nets::alone, script, 10ms);
  EXPECT_EQ(control(system, {"simulate", "--for", "1s"}), 1);
}

TEST(CommandLine, InterruptedRunIs130) {
  TestSystem system;
  Script script;
  script.call = [](ScriptState&) { kill(getpid(), SIGINT); };  // more than once before it stops
  system.add("robot.a", nets::alone, script, 1ms);
  EXPECT_EQ(control(system, {"run"}), 130);
}

TEST(CommandLine, DurationsHaveUnits) {
  EXPECT_EQ(parse_duration("60s"), Duration(60s));
  EXPECT_EQ(parse_duration("90"), Duration(90s));
  EXPECT_EQ(parse_duration("1.5 min"), Duration(90s));
  EXPECT_EQ(parse_duration("200ms"), Duration(200ms));
  EXPECT_EQ(parse_duration("1e3ms"), Duration(1s));
  EXPECT_EQ(parse_duration("2h"), Duration(2h));
  for (const char* wrong : {"", "s", "-1s", "1parsec", "1s1", "nan", "inf", "1e30h"})
    EXPECT_EQ(parse_duration(wrong), std::nullopt) << wrong;
}

TEST(CommandLine, DriversHaveAKindATargetAndOptions) {
  std::string error;
  const auto request =
      parse_driver("robot.sensor.left=reflectance:eye_left,noise=0.01,footprint=0.02", error);
  ASSERT_TRUE(request) << error;
  EXPECT_EQ(request->path, "robot.sensor.left");
  EXPECT_EQ(request->kind, "reflectance");
  EXPECT_EQ(request->targets, std::vector<std::string>{"eye_left"});
  ASSERT_EQ(request->options.size(), 2U);
  EXPECT_EQ(std::get<double>(request->options.at("noise").values.at(0).value), 0.01);
  EXPECT_EQ(std::get<double>(request->options.at("footprint").values.at(0).value), 0.02);
  for (const char* wrong : {"robot.sensor.left", "=a:b", "x=a", "x=:b", "x=a:b,noise", "x=a:b,noise=much"})
    EXPECT_FALSE(parse_driver(wrong, error)) << wrong;
}

TEST(CommandLine, LimitsOfRecordingsHaveUnits) {
  const auto limit = [](const char* text) {
    const auto parsed = parse_record_limit(text);
    return parsed ? std::pair(parsed->segment_bytes, parsed->segments) : std::pair(std::uint64_t{0}, 0U);
  };
  EXPECT_EQ(limit("500MB"), std::pair(std::uint64_t{125'000'000}, 4U));
  EXPECT_EQ(limit("100 MB x 5"), std::pair(std::uint64_t{100'000'000}, 5U));
  EXPECT_EQ(limit("1.5GBx2"), std::pair(std::uint64_t{1'500'000'000}, 2U));
  EXPECT_EQ(limit("4000"), std::pair(std::uint64_t{1000}, 4U));
  for (const char* wrong : {"", "MB", "5 apples", "-5MB", "5MBx1", "5MBx2.5", "5MBx", "0", "1"})
    EXPECT_FALSE(parse_record_limit(wrong)) << wrong;
}

TEST(SimulationFile, GivesTargetsOptionsAndModels) {
  const std::string file = scratch_file("simulation.json");
  std::ofstream(file) << R"json({ "drivers": [
    { "path": "robot[0].laser.ranges", "kind": "scan", "targets": ["laser"],
      "options": { "reach": { "number": 4, "unit": "m" }, "groups": [1, 2], "noise": 0.5 } },
    { "path": "robot[0].base.speed", "kind": "actuator", "targets": ["a", "b"],
      "options": { "outside": "clamp" } } ],
    "models": [ { "instance": "robot[0]" } ],
    "checks": [ { "name": "apart", "when": "never", "formula": "contact(a, b)" } ], "measures": {},
    "use_checks": [ { "name": "battery", "resource": "energy", "most": 200 } ] })json";
  RunOptions options;
  const std::vector<DriverRequest>& drivers = options.drivers;
  WorldOptions world;
  std::string error;
  ASSERT_TRUE(read_simulation_file(file, options, world, error)) << error;
  ASSERT_EQ(drivers.size(), 2U);
  EXPECT_EQ(drivers[1].targets, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(std::get<std::string>(drivers[1].options.at("outside").values.at(0).value), "clamp");
  const WorldOption& groups = drivers[0].options.at("groups");
  EXPECT_TRUE(groups.is_list);
  EXPECT_EQ(std::get<double>(groups.values.at(1).value), 2);
  EXPECT_EQ(drivers[0].options.at("reach").values.at(0).unit, "m");
  EXPECT_EQ(world.models, R"([{"instance":"robot[0]"}])");
  EXPECT_EQ(world.checks,
            R"json({"checks":[{"formula":"contact(a, b)","name":"apart","when":"never"}]})json");
  ASSERT_EQ(options.use_checks.size(), 1U);
  EXPECT_EQ(options.use_checks[0].resource, "energy");
  EXPECT_EQ(options.use_checks[0].most, 200);
}

TEST(SimulationFile, OfAnotherFormIsRefused) {
  const std::string file = scratch_file("simulation.json");
  for (const char* text :
       {"", "{", "[]", "{}", R"({"drivers": [{}]})", R"({"drivers": [{"path": 1}]})",
        R"({"drivers": [{"path": "a", "kind": "b", "targets": "c"}]})",
        R"({"drivers": [{"path": "a", "kind": "b", "targets": [], "options": {"x": null}}]})",
        R"({"drivers": [], "use_checks": [{"name": "battery"}]})"}) {
    std::ofstream(file) << text;
    RunOptions options;
    WorldOptions world;
    std::string error;
    EXPECT_FALSE(read_simulation_file(file, options, world, error)) << text;
    EXPECT_NE(error.find("is no simulation file"), std::string::npos) << error;
  }
  RunOptions options;
  WorldOptions world;
  std::string error;
  EXPECT_FALSE(read_simulation_file("/nowhere.json", options, world, error));
}

}  // namespace
}  // namespace tessera::testing
