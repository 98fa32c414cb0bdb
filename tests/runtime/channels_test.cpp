#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// A sender and a receiver of some kinds, under some clock.
struct Pairing {
  const char* name;
  const SubsystemNet* sender;
  const SubsystemNet* receiver;
  std::span<const FusedPlace> places;
  Duration send_period, receive_period;
  Duration send_timeout{0}, receive_timeout{0};
};
const Pairing pairings[] = {
    {"asynchronous", &nets::async_sender, &nets::async_receiver, asynchronous, 1ms, 1ms},
    {"nb_to_b", &nets::nb_sender, &nets::b_receiver, buffered, 1ms, 0ms},
    {"nb_to_b_timed", &nets::nb_sender, &nets::b_receiver_timed, buffered, 5ms, 1ms, 0ms, 2ms},
    {"nb_to_nb_with_skip", &nets::nb_sender, &nets::nb_receiver, buffered, 2ms, 1ms},
    {"b_to_nb", &nets::b_sender, &nets::nb_receiver_ack, acknowledged, 0ms, 1ms},
    {"b_to_b", &nets::b_sender, &nets::b_receiver_ack, acknowledged, 1ms, 0ms},
    {"b_to_b_timed", &nets::b_sender_timed, &nets::b_receiver_ack_timed, acknowledged, 1ms, 3ms, 1ms, 1ms},
    {"store_of_two", &nets::store_sender, &nets::store_receiver, nets::two_slots, 1ms, 0ms},
};

void PrintTo(const Pairing& pairing, std::ostream* out) { *out << pairing.name; }

struct Channels : ::testing::TestWithParam<std::tuple<Pairing, RunOptions::Clock>> {};

TEST_P(Channels, RunsAreLegalFiringSequencesAndValuesArriveInOrder) {
  const auto& [pairing, clock] = GetParam();
  TestSystem system;
  Script sender, receiver;
  sender.call = [](ScriptState& state) { state.out_x = static_cast<double>(state.context.iteration) + 1; };
  constexpr int enough = 30;
  double last = 0;
  int arrivals = 0;
  bool ordered = true;
  receiver.call = [&](ScriptState& state) {
    if (!state.x.fresh) return;
    ordered = ordered && state.x.value() > last && state.x.valid;
    last = state.x.value();
    if (++arrivals == enough) state.context.stop("enough");
  };
  const auto a = system.add("robot.a", *pairing.sender, sender, pairing.send_period);
  const auto b = system.add("robot.b", *pairing.receiver, receiver, pairing.receive_period);
  system.connect(a, "x", b, "x", pairing.places, pairing.send_timeout, pairing.receive_timeout);
  RunOptions options = simulated(60s);  // a limit only
  options.clock = clock;
  options.recording = scratch_file("run");
  const RunSummary summary = run(system, options);
  EXPECT_EQ(summary.ended, "stopped: enough");
  EXPECT_FALSE(summary.failed);
  EXPECT_TRUE(ordered);
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_FALSE(recording->truncated);
  EXPECT_EQ(summary.lost_events, 0u);
  EXPECT_GT(recording->entries.size(), 50u);
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
}

[[nodiscard]] std::string name_of(const ::testing::TestParamInfo<Channels::ParamType>& parameters) {
  const auto& [pairing, clock] = parameters.param;
  return std::string(pairing.name) + (clock == RunOptions::Clock::simulated ? "_simulated" : "_steady");
}
INSTANTIATE_TEST_SUITE_P(Blocks, Channels,
                         ::testing::Combine(::testing::ValuesIn(pairings),
                                            ::testing::Values(RunOptions::Clock::simulated,
                                                              RunOptions::Clock::steady)),
                         name_of);

TEST(Channel, AParallelSendWaitsForBothPeers) {
  for (const RunOptions::Clock clock : {RunOptions::Clock::simulated, RunOptions::Clock::steady}) {
    TestSystem system;
    Script sender;
    sender.call = [](ScriptState& state) {
      state.out_x = state.out_y = static_cast<double>(state.context.iteration);
      if (state.context.iteration == 12) state.context.stop("enough");
    };
    const auto a = system.add("robot.a", nets::parallel_sender, sender);
    const auto b = system.add("robot.b", nets::b_receiver_ack, {}, 1ms);
    const auto c = system.add("robot.c", nets::b_receiver_ack, {}, 3ms);
    system.connect(a, "x", b, "x", acknowledged);
    system.connect(a, "y", c, "x", acknowledged);
    RunOptions options = simulated(60s);
    options.clock = clock;
    options.recording = scratch_file("run");
    const RunSummary summary = run(system, options);
    std::string error;
    const auto recording = read_recording(options.recording, error);
    ASSERT_TRUE(recording) << error;
    EXPECT_EQ(complaint_about(*recording, system.system()), "");
    EXPECT_EQ(summary.ended, "stopped: enough");
    EXPECT_GE(summary.simulated, 30ms) << "the slower receiver sets the pace";
  }
}

TEST(Channel, ARingOfRelaysKeepsGoingInBothClocks) {
  for (const RunOptions::Clock clock : {RunOptions::Clock::simulated, RunOptions::Clock::steady}) {
    TestSystem system;
    std::atomic<int> left = 3;
    Script relay;
    relay.call = [&left](ScriptState& state) {
      if (state.context.iteration == 10 && --left == 0) state.context.stop("enough");
    };
    for (const char* path : {"one.r", "two.r", "three.r"}) system.add(path, nets::async_relay, relay, 1ms);
    for (std::uint32_t index = 0; index < 3; ++index)
      system.connect(index, "out", (index + 1) % 3, "in", asynchronous);
    RunOptions options = simulated(60s);
    options.clock = clock;
    options.recording = scratch_file("run");
    const RunSummary summary = run(system, options);
    std::string error;
    const auto recording = read_recording(options.recording, error);
    ASSERT_TRUE(recording) << error;
    EXPECT_EQ(complaint_about(*recording, system.system()), "");
    EXPECT_EQ(summary.ended, "stopped: enough");
  }
}

struct Seen {
  bool timed_out, fresh, valid;
  double value;
  bool operator==(const Seen&) const = default;
};

TEST(Channel, AReceiveTimeoutSaysSoAndLeavesTheValue) {
  TestSystem system;
  std::vector<Seen> seen;
  Script receiver;
  receiver.call = [&](ScriptState& state) {
    seen.push_back({state.x.timed_out, state.x.fresh, state.x.valid, state.x.value()});
  };
  Script sender;
  sender.call = [](ScriptState& state) { state.out_x = 7; };
  const auto a = system.add("robot.a", nets::nb_sender, sender, 100ms);
  const auto b = system.add("robot.b", nets::b_receiver_timed, receiver);
  system.connect(a, "x", b, "x", buffered, 0ms, 30ms);
  EXPECT_FALSE(run(system, simulated(135ms)).failed);
  // Called at 0; received at 0; timed out at 30, 60, 90; received at 100; timed out at 130.
  const Seen before{false, false, false, 0}, received{false, true, true, 7}, waited{true, false, true, 7};
  EXPECT_EQ(seen, (std::vector<Seen>{before, received, waited, waited, waited, received, waited}));
}

/// blocking_once: after the first value no receive waits, and each reads the newest one.
TEST(Channel, AReceiverThatWaitsOnceReadsTheNewestValueFromThenOn) {
  TestSystem system;
  std::vector<Seen> seen;
  Script receiver;
  receiver.call = [&](ScriptState& state) {
    seen.push_back({state.x.timed_out, state.x.fresh, state.x.valid, state.x.value()});
  };
  Script sender;
  sender.call = [sent = 0](ScriptState& state) mutable { state.out_x = ++sent; };
  const auto b = system.add("robot.b", nets::once_receiver, receiver, 20ms);
  const auto a = system.add("robot.a", nets::nb_sender, sender, 50ms);
  system.connect(a, "x", b, "x", buffered, 0ms, 30ms);
  EXPECT_FALSE(run(system, simulated(115ms)).failed);
  // Sent at 0, 50 and 100. A call computes with the value that was received after the call before.
  const Seen before{false, false, false, 0}, first{false, true, true, 1}, again{false, false, true, 1},
      second{false, true, true, 2}, second_again{false, false, true, 2};
  EXPECT_EQ(seen, (std::vector<Seen>{before, first, again, again, second, second_again}));
}

TEST(Channel, ASendTimeoutSaysSoUntilTheNextAcknowledgement) {
  TestSystem system;
  std::vector<bool> timed_out;
  std::vector<Duration> at;
  Script sender;
  sender.call = [&](ScriptState& state) {
    timed_out.push_back(state.out_x.timed_out);
    at.push_back(state.context.now.time_since_epoch());
  };
  const auto a = system.add("robot.a", nets::b_sender_timed, sender);
  const auto b = system.add("robot.b", nets::b_receiver_ack, {}, 50ms);
  system.connect(a, "x", b, "x", acknowledged, 40ms);
  EXPECT_FALSE(run(system, simulated(95ms)).failed);
  // Acknowledged at once at 0 and waited for again: gives up at 40, is acknowledged at 50, gives up at 90.
  EXPECT_EQ(at, (std::vector<Duration>{0ms, 0ms, 40ms, 50ms, 90ms}));
  EXPECT_EQ(timed_out, (std::vector<bool>{false, false, true, false, true}));
}

TEST(Channel, ConditionsSeeTheAgeOfTheInstantAtWhichTheyAreEvaluated) {
  TestSystem system;
  std::vector<Duration> at_call, at_decision;
  Script receiver;
  receiver.call = [&](ScriptState& state) { at_call.push_back(state.x.age); };
  receiver.decide = [&](const ScriptState& state) {
    at_decision.push_back(state.x.age);
    return Outcome::go_on;
  };
  const auto a = system.add("robot.a", nets::nb_sender, {}, 100ms);
  const auto b = system.add("robot.b", nets::b_receiver_timed, receiver);
  system.connect(a, "x", b, "x", buffered, 0ms, 30ms);
  EXPECT_FALSE(run(system, simulated(70ms)).failed);
  EXPECT_EQ(at_call, (std::vector<Duration>{Duration::max(), 0ms, 30ms, 60ms}));
  EXPECT_EQ(at_decision, (std::vector<Duration>{0ms, 30ms, 60ms}));
}

}  // namespace
}  // namespace tessera::testing
