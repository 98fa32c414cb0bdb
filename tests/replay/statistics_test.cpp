#include "replay/statistics.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "constructed.hpp"
#include "replay/perfetto.hpp"

using tessera::replay::statistics_of;

namespace {

/// Three iterations, 0.1 s and then 0.3 s apart, of which the last fails.
Constructed three_iterations() {
  Constructed run({"robot.control"});
  run.fire(0.0, 0, "t_in");
  for (const double at_s : {1.0, 1.1, 1.4})
    run.fire(at_s, 0, "go.t1")
        .fire(at_s + 0.02, 0, "go.snd.motion.t1")
        .fire(at_s + 0.02, 0, "go.snd.motion.t2")
        .fire(at_s + 0.03, 0, at_s > 1.3 ? "go.t6" : "go.t4");
  run.fire(1.5, 0, "go.rcv.line.timeout").fire(1.5, 0, "go.rcv.other.skip").fire(1.5, 0, "go.snd.motion.t1o");
  return run;
}

TEST(Statistics, PeriodsIterationsAndWaitsAreThoseOfTheFirings) {
  const auto all = statistics_of(three_iterations().recording);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].iterations, 3U);
  EXPECT_EQ(all[0].errors, 1U);
  EXPECT_EQ(all[0].timeouts, 1U);
  EXPECT_EQ(all[0].skips, 1U);
  EXPECT_EQ(all[0].overwrites, 1U);
  EXPECT_EQ(all[0].period.count, 2U);
  EXPECT_NEAR(all[0].period.least, 0.1, 1e-9);
  EXPECT_NEAR(all[0].period.median, 0.1, 1e-9);
  EXPECT_NEAR(all[0].period.p99, 0.3, 1e-9);
  EXPECT_NEAR(all[0].period.mean, 0.2, 1e-9);
  ASSERT_EQ(all[0].period.histogram.size(), 24U);
  EXPECT_EQ(all[0].period.histogram.front(), 1U);
  EXPECT_EQ(all[0].period.histogram.back(), 1U);
  EXPECT_NEAR(all[0].iteration.most, 0.03, 1e-9);
  const auto wait =
      std::ranges::find_if(all[0].waits, [](const auto& one) { return one.channel == "go.snd.motion.t1"; });
  ASSERT_NE(wait, all[0].waits.end());
  EXPECT_NEAR(wait->time.mean, 0.02, 1e-9);
}

TEST(Statistics, TransitionFunctionsTakeFromTheirCallToT1) {
  Constructed run({"robot.control"});
  run.recording.behaviours = {{"go"}};
  run.call(1.0, 0).fire(1.25, 0, "go.t1").fire(1.5, 0, "go.t4").call(2.0, 0).fire(2.5, 0, "go.t1");
  const auto all = statistics_of(run.recording);
  EXPECT_EQ(all[0].call.count, 2U);
  EXPECT_NEAR(all[0].call.least, 0.25, 1e-9);
  EXPECT_NEAR(all[0].call.most, 0.5, 1e-9);
}

TEST(Statistics, TheTimeOfCommunicationHasNoPartOfAFunctionBetweenReceivingAndSending) {
  Constructed run({"robot.control"});
  run.fire(0, 0, "t_in");
  for (const double at_s : {1.0, 2.0})
    run.fire(at_s, 0, "go.t1")
        .fire(at_s + 0.1, 0, "go.t2")
        .fire(at_s + 0.4, 0, "go.t3")
        .fire(at_s + 0.45, 0, "go.t4");
  for (auto& transition : run.recording.transitions) {
    tessera::Step& step = transition.role.step;
    step = step == tessera::Step::begin_sending     ? tessera::Step::begin_receiving
           : step == tessera::Step::end_sending     ? tessera::Step::end_receiving
           : step == tessera::Step::begin_receiving ? tessera::Step::begin_sending
                                                    : step;
  }
  const auto all = statistics_of(run.recording);
  EXPECT_EQ(all[0].iterations, 2U);
  EXPECT_NEAR(all[0].period.most, 1, 1e-9);
  EXPECT_EQ(all[0].iteration.count, 2U);
  EXPECT_NEAR(all[0].iteration.least, 0.15, 1e-9);
  EXPECT_NEAR(all[0].iteration.most, 0.15, 1e-9);
}

TEST(Perfetto, IsJsonWithARowPerSubsystemAndASlicePerIteration) {
  Constructed run = three_iterations();
  run.recording.system = "a \"quoted\" system";
  run.log(1.2, 0, 1, "looks \xff odd");
  std::ostringstream text;
  tessera::replay::write_perfetto(run.recording, text);
  const nlohmann::json trace = nlohmann::json::parse(text.str());
  std::size_t slices = 0, instants = 0, names = 0;
  for (const nlohmann::json& event : trace.at("traceEvents")) {
    slices += static_cast<std::size_t>(event.at("ph") == "X" && event.at("cat") == "iteration");
    instants += static_cast<std::size_t>(event.at("ph") == "i");
    names += static_cast<std::size_t>(event.at("ph") == "M");
  }
  EXPECT_EQ(slices, 3U);
  EXPECT_EQ(instants, 1U);
  EXPECT_EQ(names, 3U);  // the agent, the subsystem, the system
}

}  // namespace
