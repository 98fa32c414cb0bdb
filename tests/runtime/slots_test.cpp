// Channels with communication models that are not built in: several slots of memory,
// timeouts beside the channel.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// A queue of two between a sender that counts and a receiver that checks that it gets every number in order.
struct Queue {
  TestSystem system;
  std::uint64_t sent = 0, ahead = 0;  // under the simulated clock
  double last = 0;
  bool ordered = true;

  Queue(Duration send_period, Duration receive_period, double enough) {
    Script sender, receiver;
    sender.call = [this](ScriptState& state) { state.out_x = static_cast<double>(++sent); };
    receiver.call = [this, enough](ScriptState& state) {
      if (!state.x.fresh) return;  // before the first
      ordered = ordered && state.x.valid && state.x.value() == last + 1;
      last = state.x.value();
      if (last == enough) state.context.stop("enough");
    };
    const auto a = system.add("robot.a", nets::queue_sender, sender, send_period);
    const auto b = system.add("robot.b", nets::queue_receiver, receiver, receive_period);
    system.connect(a, "x", b, "x", nets::queue, 0ms, 0ms, 2);
  }
};

TEST(Slots, AQueueLosesAndSwapsNothingUnderEitherClock) {
  struct Case {
    RunOptions::Clock clock;
    Duration send_period, receive_period;
    double enough;
  };
  for (const Case& one :
       {Case{RunOptions::Clock::simulated, 1ms, 0ms, 200}, Case{RunOptions::Clock::simulated, 0ms, 2ms, 200},
        Case{RunOptions::Clock::steady, 0ms, 0ms, 5000}}) {
    Queue queue(one.send_period, one.receive_period, one.enough);
    RunOptions options = simulated(60s);  // a limit only
    options.clock = one.clock;
    options.recording = scratch_file("run");
    const RunSummary summary = run(queue.system, options);
    EXPECT_EQ(summary.ended, "stopped: enough");
    EXPECT_TRUE(queue.ordered);
    std::string error;
    const auto recording = read_recording(options.recording, error);
    ASSERT_TRUE(recording) << error;
    if (summary.lost_events == 0) {
      EXPECT_EQ(complaint_about(*recording, queue.system.system()), "");
    }
  }
}

TEST(Slots, AQueueLetsItsSenderRunAheadByItsSlots) {
  Queue queue(0ms, 10ms, 5);
  EXPECT_EQ(run(queue.system, simulated(60s)).ended, "stopped: enough");
  // Five are read; two are in the queue, and the sender has the next in hand.
  EXPECT_EQ(queue.sent, 8U);
}

TEST(Slots, AChannelMustHaveTheSlotsThatItsEndsUse) {
  TestSystem system;
  const auto a = system.add("robot.a", nets::queue_sender, {}, 1ms);
  const auto b = system.add("robot.b", nets::queue_receiver, {});
  system.connect(a, "x", b, "x", nets::queue);
  std::string error;
  EXPECT_FALSE(execute(system.system(), simulated(1s), error));
  EXPECT_EQ(error, "channel robot.a.x->robot.b.x: an end uses a slot that it does not have");
}

TEST(OwnTimeout, CountsFromTheArrivalWithoutTouchingTheChannel) {
  TestSystem system;
  std::vector<std::pair<Duration, bool>> calls;
  Script receiver;
  receiver.call = [&calls](ScriptState& state) {
    calls.emplace_back(state.context.now.time_since_epoch(), state.x.timed_out);
  };
  const auto a = system.add("robot.a", nets::nb_sender, {}, 50ms);
  const auto b = system.add("robot.b", nets::impatient_receiver, receiver);
  system.connect(a, "x", b, "x", buffered, 0ms, 20ms);
  EXPECT_FALSE(run(system, simulated(55ms)).failed);
  using Call = std::pair<Duration, bool>;
  EXPECT_EQ(calls,
            (std::vector<Call>{{0ms, false}, {0ms, false}, {20ms, true}, {40ms, true}, {50ms, false}}));
}

}  // namespace
}  // namespace tessera::testing
