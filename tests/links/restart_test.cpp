// Processes that die and begin again under the simulated clock, with the real protocol over a bad network.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "../environment.hpp"
#include "links_nets.hpp"
#include "nets.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

namespace tessera::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// A sender that waits for each of its values to be taken, with a wheel in its process, and a receiver. The
/// test
/// keeps the books, so that a restart does not change them.
struct Delivery {
  TestSystem system;
  double written = 0, confirmed = 0, last_read = 0;
  unsigned sender_starts = 0, receiver_starts = 0;
  std::vector<bool> was_read;
  std::vector<std::string> wrong;

  explicit Delivery(double most) : was_read(static_cast<std::size_t>(most) + 2) {
    const std::uint32_t from =
        system.add("robot.talk", nets::far_b_sender, {.call = [this, most](ScriptState& state) {
                     if (state.context.iteration == 0)
                       ++sender_starts;  // the fate of the value before is unknown
                     else
                       confirm();
                     if (confirmed >= most || written > most) return state.context.stop("enough");
                     state.out_x = ++written;
                   }});
    Script wheel{.call = [](ScriptState& state) { state.command = 1; }};
    wheel.acts = true;
    system.add("robot.wheel", nets::alone, std::move(wheel), 10ms, 0ms, Kind::effector);
    const std::uint32_t to = system.add("base.listen", nets::far_b_receiver,
                                        {.call =
                                             [this](ScriptState& state) {
                                               if (state.context.iteration == 0)
                                                 ++receiver_starts, last_read = 0;
                                             },
                                         .decide =
                                             [this](const ScriptState& state) {
                                               if (state.x.fresh) take(state.x);
                                               return Outcome::go_on;
                                             }});
    system.connect(from, "x", to, "x", networked_single);
    system.deploy({0, 0, 1});
  }
  void confirm() {
    confirmed = written;
    if (!was_read[static_cast<std::size_t>(written)]) wrong.push_back(fmt::format("{} is lost", written));
  }
  void take(double value) {
    if (value <= last_read) wrong.push_back(fmt::format("{} comes after {}", value, last_read));
    if (value <= confirmed) wrong.push_back(fmt::format("{} is read again, though confirmed", value));
    last_read = value;
    was_read[static_cast<std::size_t>(value)] = true;
  }
  /// How often the wheel was made safe after it had moved.
  [[nodiscard]] std::ptrdiff_t halts() const { return std::ranges::count(system.devices.commands, -1.0); }
};

/// The number of runs: some in every test, many if TESSERA_RESTARTS is set.
[[nodiscard]] std::uint64_t scenarios() { return from_environment("TESSERA_RESTARTS", share_of(60)); }

/// One of ten messages is lost, two cuts of 2 s, and each process dies once at a time that the seed draws.
TEST(Restart, NoConfirmedValueIsLostOrReadAgainAndEveryWheelIsSafe) {
  unsigned during_cuts = 0;
  for (unsigned seed = 1; seed <= scenarios(); ++seed) {
    Delivery delivery(400);
    std::mt19937 random(seed);
    const auto drawn = [&](unsigned most) { return 100 + static_cast<unsigned>(random() % most); };
    RunOptions options = simulated(1h);
    options.seed = seed;
    options.network.conditions = "delay=2ms,jitter=1ms,loss=0.1,duplicate=0.1,reorder=0.1";
    const unsigned cut = drawn(2000), sender = drawn(3000), receiver = drawn(3000);
    during_cuts += static_cast<unsigned>(sender >= cut && sender < cut + 2000);
    options.inject = {fmt::format("link:p0-p1:cut=2s@{}ms", cut),
                      fmt::format("link:p0-p1:cut=2s@{}ms", drawn(9000)),
                      fmt::format("process:p0:restart={}ms@{}ms", drawn(2000), sender),
                      fmt::format("process:p1:restart={}ms@{}ms", drawn(2000), receiver)};
    const RunSummary summary = run(delivery.system, options);
    ASSERT_EQ(summary.ended, "stopped: enough") << "seed " << seed;
    ASSERT_THAT(delivery.wrong, ::testing::IsEmpty()) << "seed " << seed;
    ASSERT_EQ(delivery.sender_starts, 2U) << seed;
    ASSERT_EQ(delivery.receiver_starts, 2U) << seed;
    ASSERT_EQ(delivery.halts(), 2) << "when its process died, and at the end; seed " << seed;
  }
  EXPECT_GT(during_cuts, 0U);
}

TEST(Restart, OneThatDoesNotComeBackIsDisconnectedAndItsDevicesStaySafe) {
  TestSystem system;
  std::vector<bool> told;
  const std::uint32_t from = system.add("robot.talk", nets::far_nb_sender,
                                        {.call =
                                             [&](ScriptState& state) {
                                               told.push_back(state.out_x.disconnected);
                                               state.out_x = 1;
                                             }},
                                        100ms);
  const std::uint32_t to = system.add("base.listen", nets::far_b_receiver, {});
  Script wheel{.call = [](ScriptState& state) { state.command = 1; }};
  wheel.acts = true;
  system.add("base.wheel", nets::alone, std::move(wheel), 10ms, 0ms, Kind::effector);
  system.connect(from, "x", to, "x", networked);
  system.deploy({0, 1, 1});
  RunOptions options = simulated(10s);
  options.inject = {"process:p1:crash@2s"};
  const RunSummary summary = run(system, options);
  EXPECT_EQ(summary.ended, "duration");
  EXPECT_FALSE(summary.failed) << "whoever waits for nobody goes on";
  ASSERT_EQ(told.size(), 100U);
  EXPECT_FALSE(told[15]);
  EXPECT_FALSE(told[25]) << "it is not known yet";
  EXPECT_TRUE(told[35]);
  EXPECT_TRUE(told[95]);
  ASSERT_FALSE(system.devices.commands.empty());
  EXPECT_EQ(system.devices.commands.back(), -1);
  EXPECT_NEAR(static_cast<double>(system.devices.commands.size()), 200, 3) << "nothing after its death";
}

TEST(Restart, ARestartWithinTheLivelinessShowsAsGoneAndThere) {
  TestSystem system;
  std::vector<bool> told;
  const std::uint32_t from = system.add("robot.talk", nets::far_nb_sender,
                                        {.call =
                                             [&](ScriptState& state) {
                                               told.push_back(state.out_x.disconnected);
                                               state.out_x = 1;
                                             }},
                                        1ms);
  const std::uint32_t to = system.add("base.listen", nets::far_b_receiver, {});
  system.connect(from, "x", to, "x", networked);
  system.deploy({0, 1});
  RunOptions options = simulated(1s);
  options.inject = {"process:p1:restart=100ms@0.5s"};
  options.recording = scratch_file("restart.tsr");
  static_cast<void>(run(system, options));
  EXPECT_FALSE(told[605]);
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  std::vector<std::string> lives, peers;
  for (const Recording::Entry& entry : recording->entries) {
    if (entry.event.kind() == Event::Kind::process)
      lives.push_back(
          fmt::format("{} {} {}", entry.event.time_ns / 1'000'000, entry.event.version, entry.text));
    if (entry.event.kind() == Event::Kind::peer && entry.event.instance() == from)
      peers.push_back(entry.text);
  }
  EXPECT_THAT(lives, ::testing::ElementsAre("500 0 p1\n1", "600 1 p1\n2"));
  const std::string first = file_bytes(options.recording);
  options.recording = scratch_file("again.tsr");
  told.clear();
  static_cast<void>(run(system, options));
  EXPECT_EQ(file_bytes(options.recording), first) << "the same seed gives the same bytes";
}

TEST(Restart, WhatIsWrongWithADeathIsSaid) {
  Delivery delivery(3);
  const auto refused = [&](RunOptions options, std::vector<std::string> inject) {
    options.inject = std::move(inject);
    std::string error;
    EXPECT_FALSE(execute(delivery.system.system(), options, error));
    return error;
  };
  EXPECT_THAT(refused(simulated(1s), {"process:p9:crash@1s"}),
              HasSubstr("'p9' is no process; there are p0, p1"));
  EXPECT_THAT(refused(simulated(1s), {"process:p1@1s"}), HasSubstr("expected process:PROCESS:crash@WHEN"));
  EXPECT_THAT(refused(simulated(1s), {"process:p1:restart=soon@1s"}), HasSubstr("'soon' is no time"));
  EXPECT_THAT(refused(simulated(1s), {"process:p1:crash@1s..2s"}), HasSubstr("a process dies at one time"));
  EXPECT_THAT(refused(simulated(1s), {"process:p1:restart=1s@1s", "process:p1:crash@1.5s"}),
              HasSubstr("p1 dies twice without having begun again"));
  RunOptions real = steady(1s);
  real.network.process = "p0";
  EXPECT_THAT(refused(real, {"process:p0:crash@1s"}), HasSubstr("simulated clock only"));
  RunOptions watched = simulated(1s);
  watched.monitor = true;
  EXPECT_THAT(refused(watched, {"process:p0:crash@1s"}), HasSubstr("cannot be controlled"));
}

}  // namespace
}  // namespace tessera::testing
