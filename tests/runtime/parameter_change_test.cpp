#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <string>
#include <vector>

#include "../eventually.hpp"
#include "controlled_run.hpp"
#include "nets.hpp"
#include "rerun/rerun.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

TEST_F(Controlled, AParameterIsSetWhileItRunsAndRunsAgainFromTheRecording) {
  std::atomic<double> seen{0};
  build_ = [&](TestSystem& system) {
    Script script;
    script.call = [&](ScriptState& state) {
      state.out_x = state.gain;
      seen = state.gain;
    };
    const std::uint32_t a = system.add("robot.a", nets::async_sender, script, 2ms);
    const std::uint32_t b = system.add("robot.b", nets::async_receiver, {}, 2ms);
    system.connect(a, "x", b, "x", asynchronous);
  };
  options_.clock = RunOptions::Clock::steady;
  options_.duration = 600s;
  options_.values = RunOptions::Values::all;
  start();
  const auto set = [&](const char* path, const char* value) {
    return command({{"command", "set"}, {"path", path}, {"value", value}});
  };
  const auto offered = [&](const char* path) {
    send_line(R"({"command": "offers", "id": 1000})");
    const nlohmann::json answer =
        await([](const nlohmann::json& line) { return line.value("answer", 0) == 1000; });
    for (const nlohmann::json& one : answer.at("offered").at("parameters"))
      if (one.at("path") == path) return one.dump();
    return std::string("none");
  };
  EXPECT_EQ(offered("robot.a.gain"),
            R"({"maximum":10.0,"minimum":0.0,"path":"robot.a.gain","unit":"m/s","value":"1"})");
  EXPECT_EQ(set("robot.a.gain", "11"), "parameter robot.a.gain = 11: 11 is out of range 0 to 10");
  EXPECT_EQ(command({{"command", "set"}, {"path", "gain"}, {"value", "3"}, {"try", true}}), "");
  EXPECT_NE(command({{"command", "set"}, {"path", "gain"}, {"value", "11"}, {"try", true}}), "");
  EXPECT_EQ(set("gian", "2"), "unknown parameter 'gian'; did you mean 'gain'?");
  EXPECT_NE(command({{"command", "set"}, {"path", "gain"}, {"value", 2}}), "") << "a value is text";
  EXPECT_EQ(set("gain", "250 cm/s"), "");
  EXPECT_EQ(offered("robot.b.gain"),
            R"({"maximum":10.0,"minimum":0.0,"path":"robot.b.gain","unit":"m/s","value":"2.5"})");
  EXPECT_TRUE(eventually([&] { return seen == 2.5; }));
  kill(getpid(), SIGTERM);
  running_.join();

  std::string error;
  const auto recording = read_recording(options_.recording, error);
  ASSERT_TRUE(recording) << error;
  std::vector<std::string> changes;
  for (const auto& [event, text] : recording->entries)
    if (event.kind() == Event::Kind::parameter) changes.push_back(text);
  EXPECT_THAT(changes, ::testing::UnorderedElementsAre("robot.a.gain=250 cm/s", "robot.b.gain=250 cm/s"));
  const auto again = rerun(system_.system(), RunOptions{}, options_.recording, error);
  ASSERT_TRUE(again) << error;
  EXPECT_FALSE(again->first) << again->first->what << ": " << again->first->recorded << ", "
                             << again->first->computed;
}

}  // namespace
}  // namespace tessera::testing
