// Iterations that skip a send: nothing comes, a receiver that blocks waits, and the recording has it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using ::testing::ElementsAre;

/// A sender that waits for its answer, at 10 ms, and a receiver that blocks.
struct Talk {
  TestSystem system;
  Script sender{.writes = false};
  std::vector<double> received;
  std::vector<bool> valid, timed_out;  // what the receiver got; what the conditions of the sender saw
  RunSummary summary{};

  void run_for(Duration duration, Duration receiver_period = 0ms) {
    Script receiver;
    receiver.call = [this](ScriptState& state) {
      if (state.context.iteration == 0) return;
      received.push_back(state.x);
      valid.push_back(state.x.valid);
    };
    sender.decide = [this](const ScriptState& state) {
      timed_out.push_back(state.out_x.timed_out);
      return Outcome::go_on;
    };
    const auto a = system.add("robot.a", nets::b_sender_skipping, sender, 10ms);
    const auto b = system.add("robot.b", nets::b_receiver_ack, receiver, receiver_period);
    system.connect(a, "x", b, "x", acknowledged, 5ms);
    RunOptions options = simulated(duration);
    options.recording = scratch_file("run");
    summary = run(system, options);
    std::string error;
    const auto recording = read_recording(options.recording, error);
    ASSERT_TRUE(recording) << error;
    EXPECT_EQ(complaint_about(*recording, system.system()), "");
  }
};

void count_up(ScriptState& state) { state.out_x = static_cast<double>(state.context.iteration) + 1; }

TEST(SkippedSends, OfAConditionAreNotReceived) {
  Talk talk;
  talk.sender.call = count_up;
  talk.sender.sends = [](const ScriptState& state) {
    return state.context.iteration % 3 == 0 ? Sending::sends : Sending::skips;
  };
  talk.run_for(75ms);
  EXPECT_FALSE(talk.summary.failed) << talk.summary.ended;
  EXPECT_THAT(talk.received, ElementsAre(1, 4, 7));
}

TEST(SkippedSends, OfAFunctionAreThoseItSkipsAndThoseBeforeItsFirstWrite) {
  Talk talk;
  talk.sender.call = [](ScriptState& state) {
    if (state.context.iteration < 2) return;
    count_up(state);
    if (state.context.iteration % 2 == 0) state.out_x.skip();
  };
  talk.sender.sends = [](const ScriptState&) { return Sending::by_function; };
  talk.run_for(75ms);
  EXPECT_FALSE(talk.summary.failed) << talk.summary.ended;
  EXPECT_THAT(talk.received, ElementsAre(4, 6, 8));
  EXPECT_THAT(talk.valid, ElementsAre(true, true, true));
}

TEST(SkippedSends, HaveNotTimedOut) {
  Talk talk;
  talk.sender.call = count_up;
  talk.sender.sends = [](const ScriptState& state) {
    return state.context.iteration == 2 ? Sending::skips : Sending::sends;
  };
  talk.run_for(38ms, 1s);  // the receiver takes the first value alone
  EXPECT_THAT(talk.timed_out, ElementsAre(false, true, false, true));
}

/// The receiver would wait for what the net says is sent.
TEST(SkippedSends, ThatNothingAllowsAreAFailure) {
  Talk talk;
  talk.sender.call = [](ScriptState& state) {
    count_up(state);
    if (state.context.iteration == 2) state.out_x.skip();
  };
  talk.sender.route = [](const ScriptState&, bool) { return 0; };
  talk.run_for(75ms);
  EXPECT_TRUE(talk.summary.failed);
  EXPECT_EQ(talk.summary.subsystems.at(0).errors, 1U);
  EXPECT_THAT(talk.received, ElementsAre(1, 2, 2));
  EXPECT_THAT(talk.valid, ElementsAre(true, true, false)) << "the failure is told";
}

TEST(SkippedSends, ADecisionThatThrowsIsAFailureAndSendsThatNothingIsValid) {
  Talk talk;
  talk.sender.call = count_up;
  talk.sender.sends = [](const ScriptState& state) {
    if (state.context.iteration == 1) throw std::runtime_error("no decision");
    return Sending::sends;
  };
  talk.run_for(75ms);
  EXPECT_TRUE(talk.summary.failed);
  EXPECT_THAT(talk.valid, ElementsAre(true, false));
}

}  // namespace
}  // namespace tessera::testing
