// Deployed systems under the simulated clock: every channel crosses a bad network.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "links_nets.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

namespace tessera::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr const char* bad = "delay=2ms,jitter=1ms,loss=0.1,duplicate=0.1,reorder=0.1";

/// A sender that numbers its values from 1, and a receiver that stores the values it reads.
struct Crossing {
  TestSystem system;
  std::vector<double> read;        ///< fresh values
  std::vector<double> sent_after;  ///< per send that has ended: what had been read until then
  std::vector<double> given_up;
  double written = 0;

  Crossing(const SubsystemNet& sender, const SubsystemNet& receiver, std::span<const FusedPlace> places,
           double most, Duration send_period, Duration receive_period, Duration send_timeout = 0s) {
    const std::uint32_t from = system.add("robot.talk", sender,
                                          {.call =
                                               [this, most](ScriptState& state) {
                                                 if (written > 0) after_send(state);
                                                 if (written == most) return state.context.stop("enough");
                                                 state.out_x = ++written;
                                               }},
                                          send_period);
    const std::uint32_t to = system.add("base.listen", receiver,
                                        {.call = [](ScriptState&) {},
                                         .decide =
                                             [this](const ScriptState& state) {
                                               if (state.x.fresh) read.push_back(state.x);
                                               return Outcome::go_on;
                                             }},
                                        receive_period);
    system.connect(from, "x", to, "x", places, send_timeout, 0s);
    system.deploy({0, 1});
  }
  void after_send(const ScriptState& state) {
    sent_after.push_back(read.empty() ? 0 : read.back());
    if (state.out_x.timed_out) given_up.push_back(written);
  }
};

RunOptions over(const std::string& conditions, std::vector<std::string> inject = {}) {
  RunOptions options = simulated(1h);
  options.network.conditions = conditions;
  options.inject = std::move(inject);
  return options;
}

void expect_increasing(const std::vector<double>& values) {
  EXPECT_EQ(std::ranges::adjacent_find(values, [](double a, double b) { return a >= b; }), values.end())
      << "a value was read twice, or an older one after a newer one";
}

TEST(Crossing, ABlockingSendEndsWhenItsValueWasTakenWhateverTheNetworkLoses) {
  Crossing crossing(nets::far_b_sender, nets::far_b_receiver, networked_single, 10'000, 0s, 0s);
  const RunSummary summary =
      run(crossing.system, over(bad, {"link:p0-p1:cut=2s@3s", "link:p1-p0:cut=1s@20s"}));
  EXPECT_EQ(summary.ended, "stopped: enough");
  ASSERT_EQ(crossing.read.size(), 10'000U) << "every value once";
  expect_increasing(crossing.read);
  for (std::size_t at = 0; at < crossing.sent_after.size(); ++at)
    ASSERT_GE(crossing.sent_after[at], static_cast<double>(at + 1))
        << "a send has ended that nobody has read";
}

/// A receiver without a sender announces itself repeatedly, as often as the sender repeats.
TEST(Crossing, AValueThatIsFirstSentDuringACutArrivesWheneverTheCutEnds) {
  for (Duration end = 200ms; end < 2s; end += 50ms) {
    Crossing crossing(nets::far_b_sender, nets::far_b_receiver, networked_single, 1, 0s, 0s);
    RunOptions options =
        over("", {fmt::format("link:p0-p1:cut={}ms@0.1s", end / 1ms), "robot.talk.run:stall=137ms@0s"});
    options.duration = 5s;
    EXPECT_EQ(run(crossing.system, options).ended, "stopped: enough") << end / 1ms;
  }
}

TEST(Crossing, AValueThatWasGivenUpIsReadOnceOrNever) {
  Crossing crossing(nets::far_b_sender_timed, nets::far_b_receiver, networked, 3'000, 0s, 0s, 15ms);
  EXPECT_EQ(run(crossing.system, over(bad)).ended, "stopped: enough");
  expect_increasing(crossing.read);
  EXPECT_GT(crossing.given_up.size(), 100U);
  for (double value = 1; value <= 3'000; ++value)
    if (!std::ranges::binary_search(crossing.given_up, value)) {
      ASSERT_TRUE(std::ranges::binary_search(crossing.read, value)) << value << " was acknowledged unread";
    }
}

TEST(Crossing, ANonBlockingSenderIsNeverHeldUpAndTheNewestValueArrives) {
  Crossing crossing(nets::far_nb_sender, nets::far_b_receiver, networked, 2'000, 5ms, 0s);
  EXPECT_EQ(run(crossing.system, over(bad, {"link:p0-p1:cut=3s@2s"})).ended, "stopped: enough");
  expect_increasing(crossing.read);
  EXPECT_GT(crossing.read.size(), 800U);
  EXPECT_GT(crossing.read.back(), 1'900) << "the newest is repeated until it was taken";
}

/// A sender that writes its output from its fourth iteration on, and begins again in the middle of the run.
TEST(Crossing, AnOutputThatWasNotWrittenSinceTheStartOfItsProcessIsInvalid) {
  TestSystem system;
  Script sender{.call =
                    [](ScriptState& state) {
                      if (state.context.iteration >= 3) state.out_x = 7;
                    },
                .writes = false};
  struct Seen {
    double value;
    bool fresh, valid, failed;
    Duration age;
  };
  std::vector<Seen> seen;
  Script receiver{.call = [&](ScriptState& state) {
    const auto& x = state.x;
    seen.push_back({x, x.fresh, x.valid, x.failed, x.age});
  }};
  const auto from = system.add("robot.talk", nets::far_nb_sender, sender, 10ms);
  const auto to = system.add("base.listen", nets::far_nb_receiver, receiver, 10ms);
  system.connect(from, "x", to, "x", networked, 0s, 0s);
  system.deploy({0, 1});
  RunOptions options = over("delay=1ms", {"process:p0:restart=200ms@1s"});
  options.duration = 2s;
  EXPECT_FALSE(run(system, options).failed);
  std::vector<Seen> invalid;
  for (const Seen& one : seen) {
    EXPECT_FALSE(one.valid && one.failed);
    if (one.valid) EXPECT_EQ(one.value, 7);
    if (!one.failed) continue;
    EXPECT_FALSE(one.fresh);
    invalid.push_back(one);
  }
  ASSERT_GE(invalid.size(), 4U) << "after both starts";
  EXPECT_EQ(invalid.front().value, 0);
  EXPECT_EQ(invalid.front().age, Duration::max());
  EXPECT_EQ(invalid.back().value, 7) << "the last valid value stays";
  EXPECT_GT(invalid.back().age, 200ms);
  EXPECT_LT(invalid.back().age, 2s);
  EXPECT_TRUE(seen.back().valid && seen.back().fresh);
}

TEST(Crossing, WhoNeverWaitsReadsTheLatest) {
  Crossing skips(nets::far_b_sender_timed, nets::far_nb_receiver, networked, 500, 20ms, 7ms, 100ms);
  EXPECT_EQ(run(skips.system, over(bad)).ended, "stopped: enough");
  expect_increasing(skips.read);
  EXPECT_GT(skips.read.size(), 300U);
}

TEST(Crossing, AnExchangeNeverGoesBack) {
  Crossing exchanged(nets::far_exchange_sender, nets::far_exchange_receiver, networked_exchange, 2'000, 5ms,
                     3ms);
  EXPECT_EQ(run(exchanged.system, over(bad)).ended, "stopped: enough");
  expect_increasing(exchanged.read);
  EXPECT_GT(exchanged.read.size(), 1'000U);
}

TEST(Crossing, TheSameSeedGivesTheSameBytes) {
  const auto recorded = [](std::uint64_t seed, const char* name) {
    Crossing crossing(nets::far_b_sender_timed, nets::far_b_receiver, networked, 200, 0s, 0s, 15ms);
    RunOptions options = over(bad, {"link:p0-p1:cut=1s@1s"});
    options.seed = seed;
    options.recording = scratch_file(name);
    static_cast<void>(run(crossing.system, options));
    return file_bytes(options.recording);
  };
  const std::string once = recorded(7, "a.tsr");
  EXPECT_EQ(once, recorded(7, "b.tsr"));
  EXPECT_NE(once, recorded(8, "c.tsr"));
}

/// The version of an event is the number of a value: values taken were written, and acknowledged ones were
/// taken.
TEST(Crossing, ARecordingTellsWhichValueWasReadWhen) {
  Crossing crossing(nets::far_b_sender, nets::far_b_receiver, networked_single, 100, 0s, 0s);
  RunOptions options = over(bad);
  options.recording = scratch_file("numbers.tsr");
  static_cast<void>(run(crossing.system, options));
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_EQ(recording->processes, (std::vector<std::string>{"p0", "p1"}));
  EXPECT_EQ(recording->networked, (std::vector<std::string>{"robot.talk.x->base.listen.x"}));
  EXPECT_FALSE(recording->process);
  std::map<std::string, std::uint32_t> last;
  int peers = 0;
  for (const Recording::Entry& entry : recording->entries) {
    if (entry.event.kind() == Event::Kind::peer) {
      EXPECT_EQ(entry.text, "robot.talk.x->base.listen.x\n1");
      ++peers;
    }
    if (entry.event.kind() != Event::Kind::firing) continue;
    const std::string& name = recording->transitions[entry.event.subject].name;
    const std::uint32_t number = entry.event.version;
    if (name.ends_with("snd.x.t2")) {
      EXPECT_EQ(number, last["written"]++ + 1);
    }
    if (name.ends_with("rcv.x.t1")) {
      EXPECT_EQ(number, last["read"]++ + 1);
    }
    if (name.ends_with("rcv.x.t2")) {
      EXPECT_EQ(number, last["read"]);
    }
    if (name.ends_with("snd.x.t3")) {
      EXPECT_EQ(number, last["written"]);
      EXPECT_EQ(number, last["read"]) << "acknowledged before it was read";
    }
  }
  EXPECT_EQ(peers, 2) << "one of each end";
  EXPECT_EQ(last["read"], 100U);
}

class Silence : public ::testing::TestWithParam<int> {};

TEST_P(Silence, IsToldToASubsystemAfterTheLivelinessOfTheDeployment) {
  const int liveliness = GetParam();  // in periods
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
  system.connect(from, "x", to, "x", networked);
  system.deploy({0, 1}, liveliness * 100ms);
  RunOptions options = over("", {"link:p0-p1:cut=3s@2s"});
  options.duration = 10s;
  static_cast<void>(run(system, options));
  ASSERT_EQ(told.size(), 100U);
  EXPECT_FALSE(told[15]) << "before the cut";
  EXPECT_FALSE(told.at(20 + liveliness - 1)) << "they have not been silent for so long";
  EXPECT_TRUE(told.at(20 + liveliness + 1));
  EXPECT_TRUE(told[49]);
  EXPECT_FALSE(told[55]);
}
INSTANTIATE_TEST_SUITE_P(Links, Silence, ::testing::Values(2, 9, 25));

TEST(Crossing, ARunInWhichNothingCanHappenEnds) {
  TestSystem system;
  const std::uint32_t from = system.add("robot.talk", nets::far_b_sender, {});
  const std::uint32_t to = system.add("base.listen", nets::far_b_receiver,
                                      {.decide = [](const ScriptState&) { return Outcome::terminal; }});
  system.connect(from, "x", to, "x", networked_single);
  system.deploy({0, 1});
  const RunSummary summary = run(system, over(""));
  EXPECT_THAT(summary.ended, HasSubstr("nothing can ever happen again"));
  EXPECT_THAT(summary.ended, HasSubstr("waits for process p1 over 'x'"));
}

TEST(Crossing, WhatCannotRunSaysWhy) {
  Crossing crossing(nets::far_b_sender, nets::far_b_receiver, networked_single, 3, 0s, 0s);
  const auto refused = [&](RunOptions options) {
    std::string error;
    EXPECT_FALSE(execute(crossing.system.system(), options, error));
    return error;
  };
  RunOptions options = steady(1s);
  EXPECT_EQ(refused(options),
            "test is deployed in 2 processes; say which one runs here: --process NAME (p0, p1)");
  options.network.process = "p7";
  EXPECT_EQ(refused(options), "test has no process 'p7'; there are p0, p1");
  options.network.process = "p0";
  options.network.library = "/nowhere/libtessera_dds.so";
  EXPECT_THAT(refused(options), HasSubstr("cannot load the library of the network: /nowhere"));
  EXPECT_THAT(refused(over("loss=2")), HasSubstr("'2' is no probability"));
  EXPECT_THAT(refused(over("lose=0.1")), HasSubstr("unknown 'lose'"));
  EXPECT_THAT(refused(over("delay=fast")), HasSubstr("'fast' is no time"));
  EXPECT_THAT(refused(over("", {"link:p0-p9:cut=1s@1s"})), HasSubstr("there are p0, p1"));
  EXPECT_THAT(refused(over("", {"link:p0-p1@1s"})), HasSubstr("expected link:"));
}

}  // namespace
}  // namespace tessera::testing
