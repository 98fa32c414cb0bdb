// How old commands are, as a running system measures it.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "nets.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

constexpr std::initializer_list<std::uint32_t> first_channel{0}, second_channel{1};

/// A sensor and a motor with the same rate. The motor uses in an iteration what it has received in the one before, and
/// at an instant it may receive before or after the sensor sends.
struct SensorAndMotor {
  explicit SensorAndMotor(Chain chain, Script motor = {}) {
    motor.acts = true;
    const auto from = system.add("robot.sensor", nets::async_sender, {}, 10ms, 0ms, Kind::receptor);
    const auto to = system.add("robot.motor", nets::async_receiver, motor, 10ms, 0ms, Kind::effector);
    system.connect(from, "x", to, "x", asynchronous);
    system.chains = {chain};
    system.chain_ways = {{0, first_channel}};
  }
  TestSystem system;
};

std::vector<std::string> told_in(const std::string& file) {
  std::string error;
  const std::optional<Recording> recording = read_recording(file, error);
  EXPECT_TRUE(recording) << error;
  std::vector<std::string> told;
  if (recording)
    for (const Recording::Entry& entry : recording->entries)
      if (entry.event.is_told_fault() && entry.event.fault() == Fault::overtime) told.push_back(entry.text);
  return told;
}

TEST(CommandAges, AreMeasuredBesideWhatIsProved) {
  SensorAndMotor robot({"line to wheels", 20ms, 30ms});
  RunOptions options = simulated(995ms);
  options.recording = scratch_file("run");
  const RunSummary summary = run(robot.system, options);
  ASSERT_EQ(summary.chains.size(), 1U);
  const ChainTimes& chain = summary.chains.front();
  EXPECT_EQ(chain.name, "line to wheels");
  EXPECT_EQ(chain.members, 1U);
  EXPECT_EQ(chain.longest_age, 20ms);
  EXPECT_EQ(chain.longest_reaction, 30ms);
  EXPECT_EQ(chain.proved_age, 20ms);
  EXPECT_EQ(chain.over, 0U);
  EXPECT_GT(chain.commands, 90U);
  EXPECT_EQ(told_in(options.recording), std::vector<std::string>{});
}

TEST(CommandAges, TheFirstTheTenthAndTheHundredthExcessAreTold) {
  SensorAndMotor robot({"line to wheels", 9ms, 0ms});
  RunOptions options = simulated(995ms);
  options.recording = scratch_file("run");
  const RunSummary summary = run(robot.system, options);
  EXPECT_FALSE(summary.failed);
  const ChainTimes& chain = summary.chains.front();
  EXPECT_EQ(chain.over, chain.commands);
  EXPECT_FALSE(chain.proved_reaction);
  const std::vector<std::string> told = told_in(options.recording);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_NE(told.front().find("line to wheels: a command was 10 ms old, and at most 9 ms is proved"),
            std::string::npos)
      << told.front();
}

TEST(CommandAges, ACallThatFailsGivesNoCommand) {
  Script motor;
  motor.call = [](ScriptState& state) {
    if (state.context.iteration % 2 == 1) throw std::runtime_error("every second one");
  };
  motor.decide = [](const ScriptState&) { return Outcome::go_on; };
  SensorAndMotor robot({"line to wheels", 20ms, 30ms}, motor);
  const RunSummary summary = run(robot.system, simulated(100ms));
  for (const ChainTimes& chain : summary.chains) EXPECT_LT(chain.commands, 6U);
}

TEST(CommandAges, WithoutChainsNothingIsMeasured) {
  SensorAndMotor robot({});
  robot.system.chains = {};
  robot.system.chain_ways = {};
  EXPECT_TRUE(run(robot.system, simulated(100ms)).chains.empty());
}

/// The times of a fleet are the longest ones of its members, and a message names the member.
TEST(CommandAges, TheMembersOfAFleetShareARow) {
  TestSystem system;
  for (const char* agent : {"cart[0]", "cart[1]"}) {
    Script motor;
    motor.acts = true;
    const auto from = system.add(std::string(agent) + ".eye", nets::async_sender, {}, 10ms);
    const auto to = system.add(std::string(agent) + ".wheel", nets::async_receiver, motor,
                               agent[5] == '0' ? 10ms : 20ms, 0ms, Kind::effector);
    system.connect(from, "x", to, "x", asynchronous);
  }
  system.chains = {{"cart[].eye -> cart[].wheel", 25ms, 0ms}};
  system.chain_ways = {{0, first_channel, 0}, {0, second_channel, 1}};
  RunOptions options = simulated(100ms);
  options.recording = scratch_file("run");
  const RunSummary summary = run(system, options);
  ASSERT_EQ(summary.chains.size(), 1U);
  EXPECT_EQ(summary.chains.front().members, 2U);
  EXPECT_EQ(summary.chains.front().longest_age, 30ms);
  const std::vector<std::string> told = told_in(options.recording);
  ASSERT_FALSE(told.empty());
  EXPECT_NE(told.front().find("cart[1].eye -> cart[1].wheel: a command was 30 ms old"), std::string::npos)
      << told.front();
}

}  // namespace
}  // namespace tessera::testing
