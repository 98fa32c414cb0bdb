#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "../eventually.hpp"
#include "controlled_run.hpp"
#include "nets.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using nlohmann::json;

/// An effector that commands 5, and -1 as its safe command.
class EmergencyStop : public Controlled {
 protected:
  EmergencyStop() {
    options_.clock = RunOptions::Clock::steady;
    options_.duration = 600s;
    build_ = [this](TestSystem& system) {
      Script motor;
      motor.acts = true;
      motor.call = [](ScriptState& state) { state.command = 5; };
      system.devices.accept = [this](double value) {
        (value == 7 || value == -2 ? last_of_arm_ : last_) = value;
        return true;
      };
      system.add("robot.motor", nets::alone, motor, 2ms, 0ms, Kind::effector);
    };
  }
  std::uint64_t iterations() {
    return await([](const json& line) { return line.contains("subsystems"); })
        .at("subsystems")
        .at(0)
        .at("iterations");
  }
  std::atomic<double> last_{0}, last_of_arm_{0};
};

TEST_F(EmergencyStop, StandsUntilTheOperatorResetsIt) {
  start();
  EXPECT_TRUE(eventually([&] { return last_ == 5; }));
  EXPECT_EQ(command({{"command", "reset"}}), "there is no emergency stop");
  EXPECT_EQ(command({{"command", "emergency_stop"}, {"why", "smoke"}}), "");
  EXPECT_TRUE(eventually([&] { return last_ == -1; }));
  const json shown = await([](const json& line) { return line.contains("emergency"); });
  EXPECT_EQ(shown.at("emergency"), "smoke");
  const std::uint64_t before = iterations();
  EXPECT_TRUE(eventually([&] { return iterations() > before + 10; })) << "it goes on otherwise";
  EXPECT_EQ(last_, -1);
  EXPECT_EQ(command({{"command", "reset"}}), "");
  EXPECT_TRUE(eventually([&] { return last_ == 5; }));
  kill(getpid(), SIGTERM);
  running_.join();
  EXPECT_EQ(last_, -1);
  std::string error;
  const auto recording = read_recording(options_.recording, error);
  ASSERT_TRUE(recording) << error;
  std::string texts;
  for (const auto& [event, text] : recording->entries)
    if (event.kind() == Event::Kind::log || event.kind() == Event::Kind::safe) texts += text + "\n";
  EXPECT_THAT(texts, ::testing::HasSubstr("EMERGENCY STOP: smoke"));
  EXPECT_THAT(texts, ::testing::HasSubstr("robot.motor.command: safe command: emergency stop"));
  EXPECT_THAT(texts, ::testing::HasSubstr("the emergency stop is over"));
}

TEST_F(EmergencyStop, ComesThoughTheTransitionFunctionDoesNotReturn) {
  std::atomic<bool> release{false}, hanging{false};
  build_ = [&, usual = build_](TestSystem& system) {
    usual(system);
    Script hangs;
    hangs.acts = true;
    hangs.safe = -2;
    hangs.call = [&](ScriptState& state) {
      state.command = 7;
      hanging = state.context.iteration == 3;
      if (hanging) static_cast<void>(eventually([&] { return release.load(); }));
    };
    system.add("robot.arm", nets::alone, hangs, 2ms, 0ms, Kind::effector);
  };
  start();
  EXPECT_TRUE(eventually([&] { return last_ == 5 && last_of_arm_ == 7 && hanging; }));
  EXPECT_EQ(command({{"command", "emergency_stop"}}), "");
  EXPECT_TRUE(eventually([&] { return last_ == -1 && last_of_arm_ == -2; }));
  release = true;
  kill(getpid(), SIGTERM);
  running_.join();
  EXPECT_EQ(summary_.ended, "SIGTERM");
}

TEST_F(EmergencyStop, IsAnsweredOnceTheDevicesHaveTheirSafeCommands) {
  build_ = [&, usual = build_](TestSystem& system) {
    usual(system);
    system.devices.accept = [this](double value) {
      if (value == -1) std::this_thread::sleep_for(200ms);
      last_ = value;
      return true;
    };
  };
  start();
  EXPECT_TRUE(eventually([&] { return last_ == 5; }));
  EXPECT_EQ(command({{"command", "emergency_stop"}}), "");
  EXPECT_EQ(last_, -1);
  EXPECT_EQ(command({{"command", "emergency_stop"}}), "") << "it stands already";
  EXPECT_EQ(command({{"command", "reset"}}), "");
  kill(getpid(), SIGTERM);
  running_.join();
}

TEST_F(EmergencyStop, NamesTheDeviceThatRefusesAndIsNotResetBefore) {
  build_ = [&, usual = build_](TestSystem& system) {
    usual(system);
    system.devices.accept = [this](double value) {
      if (value == -1 && last_ == 5) return false;
      last_ = value;
      return true;
    };
  };
  start();
  EXPECT_TRUE(eventually([&] { return last_ == 5; }));
  // Both come at once, so that the reset finds the stop.
  send_line("{\"id\":1,\"command\":\"emergency_stop\"}\n{\"id\":2,\"command\":\"reset\"}");
  const auto answer_to = [](int id) {
    return [id](const json& line) { return line.value("answer", 0) == id; };
  };
  EXPECT_EQ(await(answer_to(2)).value("error", ""),
            "not reset: robot.motor.command has not taken its safe command");
  EXPECT_EQ(await(answer_to(1)).value("error", ""), "robot.motor.command has not taken its safe command");
  running_.join();
  EXPECT_TRUE(summary_.failed);
  EXPECT_THAT(summary_.ended, ::testing::HasSubstr("robot.motor.command has not taken its safe command"));
}

TEST_F(EmergencyStop, ThatComesWhileDevicesAreOpenedIsInForceFromTheStart) {
  std::atomic<bool> go_on{false};
  std::atomic<int> others{0};
  build_ = [&, usual = build_](TestSystem& system) {
    usual(system);
    system.devices.accept = [&](double value) {
      if (value == -1) static_cast<void>(eventually([&] { return go_on.load(); }));
      if (value != -1) ++others;
      return true;
    };
  };
  start();
  for (const char* id : {"1", "2"}) {
    send_line("{\"id\":" + std::string(id) + ",\"command\":\"emergency_stop\"}");
    ASSERT_TRUE(eventually([&] { return has_read_all(); }));
  }
  EXPECT_EQ(others, 0) << "its device is being opened";
  go_on = true;
  EXPECT_EQ(await([](const json& line) { return line.value("answer", 0) == 1; }).value("error", "none"), "");
  const std::uint64_t before = iterations();
  EXPECT_TRUE(eventually([&] { return iterations() > before + 10; }));
  EXPECT_EQ(others, 0);
  kill(getpid(), SIGTERM);
  running_.join();
}

TEST_F(EmergencyStop, FindsRoomWhateverTheNumberOfWatchers) {
  start();
  EXPECT_TRUE(eventually([&] { return last_ == 5; }));
  std::vector<int> watchers;
  for (int count = 0; count < 200; ++count) {
    int one = -1;
    EXPECT_TRUE(eventually([&] { return (one = connect_another()) >= 0; }));
    watchers.push_back(one);
  }
  int operators = -1;
  EXPECT_TRUE(eventually([&] { return (operators = connect_another()) >= 0; }));
  const std::string line = "{\"id\":1,\"command\":\"emergency_stop\"}\n";
  EXPECT_EQ(send(operators, line.data(), line.size(), MSG_NOSIGNAL), static_cast<ssize_t>(line.size()));
  EXPECT_TRUE(eventually([&] { return last_ == -1; }));
  close(socket_);
  fcntl(operators, F_SETFL, 0);
  socket_ = operators;
  received_.clear();
  EXPECT_EQ(await([](const json& said) { return said.value("answer", 0) == 1; }).value("error", "none"), "");
  for (const int one : watchers) close(one);
  kill(getpid(), SIGTERM);
  running_.join();
}

/// Commands of a motor whose transition function throws once.
std::vector<double> commands_around_a_fault(bool operator_resets) {
  TestSystem system;
  Script motor;
  motor.acts = true;
  motor.call = [](ScriptState& state) {
    state.command = 5;
    if (state.context.iteration == 3) throw std::runtime_error("lost");
  };
  motor.route = [](const ScriptState&, bool) { return 0; };
  Policies policies;
  policies.operator_resets = operator_resets;
  system.add("robot.motor", nets::two_behaviours, motor, 10ms, 0ms, Kind::effector, policies);
  static_cast<void>(run(system, simulated(200ms)));
  return system.devices.commands;
}

TEST(Recovery, IsByItselfOrByAnOperator) {
  const std::vector<double> automatic = commands_around_a_fault(false), held = commands_around_a_fault(true);
  EXPECT_GT(std::ranges::count(automatic, 5), 10);
  EXPECT_EQ(std::ranges::count(held, 5), 3) << "those before the fault";
  EXPECT_EQ(held.back(), -1);
}

TEST(EmergencyStopOfABehaviour, ReachesEveryDeviceAtOnce) {
  TestSystem system;
  Script watches, motor;
  watches.call = [](ScriptState& state) {
    if (state.context.iteration == 5) state.context.emergency_stop("too close");
  };
  motor.acts = true;
  motor.call = [](ScriptState& state) { state.command = 5; };
  system.add("robot.watch", nets::alone, watches, 10ms);
  system.add("robot.motor", nets::alone, motor, 1s, 0ms, Kind::effector);
  RunOptions options = simulated(3s);
  options.recording = scratch_file("run");
  static_cast<void>(run(system, options));
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  std::int64_t safe_ns = -1;
  for (const auto& [event, text] : recording->entries)
    if (event.kind() == Event::Kind::safe && text.ends_with("emergency stop")) safe_ns = event.time_ns;
  EXPECT_EQ(safe_ns, 50'000'000) << "the motor's own turns are a second apart";
  EXPECT_EQ(std::ranges::count(system.devices.commands, 5), 1);
}

}  // namespace
}  // namespace tessera::testing
