// Verdicts on chains, and on rates, waits, timeouts and `stale`.
#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "follower.hpp"
#include "timing/conduct.hpp"
#include "timing/conduct/certain.hpp"
#include "timing/conduct/drift.hpp"

namespace tessera::timing {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string chain(const std::string& asks) {
  return "timing:\n  chains:\n    - { name: line to wheels, path: [robot.sensor, robot.control, "
         "robot.motor]" +
         asks + " }\n";
}

TEST(Verdicts, AnswerWhatIsAsked) {
  const Judged holds({.timing = chain(", age: 82 ms, reaction: 142 ms")});
  ASSERT_TRUE(holds.reading.model) << holds.reading.report();
  EXPECT_EQ(holds.declared.chains.at(0).name, "line to wheels");
  EXPECT_EQ(holds.declared.chains.at(0).leads, "robot.sensor -> robot.control -> robot.motor");
  EXPECT_EQ(holds.verdicts.at(0).age, Answer::holds);
  EXPECT_EQ(holds.verdicts.at(0).reaction, Answer::holds);

  const Judged unproved({.timing = chain(", reaction: 120 ms")});
  EXPECT_EQ(unproved.verdicts.at(0).age, Answer::not_asked);
  EXPECT_EQ(unproved.verdicts.at(0).reaction, Answer::unknown);

  // Nobody waits, so the bounds are exact: 142 and 162 ms.
  const Judged exact({.motion = no_waits, .timing = chain(", age: 141 ms, reaction: 162 ms")});
  EXPECT_EQ(exact.verdicts.at(0).age, Answer::violated);
  EXPECT_EQ(exact.verdicts.at(0).reaction, Answer::holds);

  const Judged silent({.sensor_takes = "", .timing = chain(", age: 1 s")});
  EXPECT_EQ(silent.verdicts.at(0).age, Answer::none);
  EXPECT_EQ(silent.verdicts.at(0).reaction, Answer::not_asked);
}

TEST(Verdicts, ABoundThatNoRunMayReachIsNotExact) {
  const auto judged = [](const std::vector<std::pair<std::string, std::string>>& changes) {
    std::string text = Follower{.motion = no_waits, .timing = chain(", age: 141 ms")}.text();
    for (const auto& [from, to] : changes) text.replace(text.find(from), from.size(), to);
    const spec::Reading reading(text);
    EXPECT_TRUE(reading.model) << reading.report();
    const Declared all = declared(*reading.model);
    return judge(all, *reading.model, Bounds(all.system), all.chains.at(0));
  };
  EXPECT_EQ(judged({}).age, Answer::violated);
  // The longest call may come at its beginning only.
  const ChainVerdict begins = judged({{"follow: { takes: 2..8 ms, next: follow }",
                                       "begin: { takes: 2..8 ms, terminal: true, next: follow }, "
                                       "follow: { takes: 2..3 ms, next: follow }"}});
  EXPECT_EQ(begins.bound.age, 142 * ms);
  EXPECT_EQ(begins.age, Answer::unknown);
  // It keeps its rate although it waits for another one, but not always as long as it may.
  const ChainVerdict waits =
      judged({{"inputs: { line: float64 }", "inputs: { other: float64, line: float64 }"},
              {"receptors: {",
               "receptors: { second: { rate: 50 Hz, real: { s: float64 }, outputs: { other: float64 },\n"
               "      behaviours: { look: { takes: 1..2 ms, next: look } } },"},
              {"channels:\n",
               "channels:\n"
               "  - { from: \"robot.second.other\", to: \"robot.control.other\", receive: blocking }\n"}});
  EXPECT_LT(waits.bound.age, unbounded);
  EXPECT_EQ(waits.age, Answer::unknown);
}

TEST(Verdicts, NothingIsAChainButWhatIsNamed) {
  EXPECT_TRUE(Judged({.timing = "timing: { chains: [] }\n"}).declared.chains.empty());
  EXPECT_EQ(Judged({.timing = "timing: { latency: 1 ms }\n"}).declared.chains.size(), 1U);
}

TEST(Verdicts, ALatencyMakesTheBoundsLarger) {
  const Judged late({.motion = no_waits, .timing = "timing: { latency: 1 ms }\n"});
  ASSERT_EQ(late.verdicts.size(), 1U);
  EXPECT_EQ(late.declared.system.latency, ms);
  EXPECT_FALSE(late.verdicts[0].exact);
  EXPECT_GT(late.verdicts[0].bound.age, 142 * ms);
}

TEST(Verdicts, NobodyIsBoundedWhoWaitsForOneThatMayEnd) {
  const std::string waits = "{ from: \"robot.sensor.line\", to: \"robot.control.line\", receive: blocking }";
  const Judged judged({.line = waits, .sensor_takes = "takes: 1..2 ms, terminal: elapsed > 1 s,"});
  ASSERT_TRUE(judged.reading.model) << judged.reading.report();
  EXPECT_EQ(judged.verdicts.at(0).why, "");  // `next: look`: it never ends

  Follower ends{.line = waits};
  std::string text = ends.text();
  const std::string next = "next: look";
  text.replace(text.find(next), next.size(), "terminal: elapsed > 1 s, next: end");
  const spec::Reading reading(text);
  ASSERT_TRUE(reading.model) << reading.report();
  const Declared all = declared(*reading.model);
  const ChainVerdict verdict = judge(all, *reading.model, Bounds(all.system), all.chains.at(0));
  EXPECT_EQ(verdict.why, "robot.control waits for robot.sensor, which may end");
}

TEST(Verdicts, AllThatIsMissingIsNoted) {
  const Judged judged(
      {.control = "rate: 20 Hz, receive: first", .sensor_takes = "", .timing = chain(", age: 1 s")});
  ASSERT_TRUE(judged.reading.model) << judged.reading.report();
  EXPECT_THAT(missing_for(judged.declared, judged.declared.chains.at(0)),
              ElementsAre("robot.sensor.look does not say what it takes",
                          "robot.control receives before its transition function (`receive: first`)"));
  diagnostics::Diagnostics notes("spec.yaml", Follower().text());
  note_missing(*judged.reading.model, notes);
  ASSERT_EQ(notes.sorted().size(), 1U);
  EXPECT_EQ(notes.sorted()[0].code, "N341");
  EXPECT_THAT(notes.sorted()[0].message, HasSubstr("robot.sensor.look does not say what it takes"));

  diagnostics::Diagnostics none("spec.yaml", "");
  note_missing(*Judged({.timing = chain(", age: 1 s")}).reading.model, none);
  note_missing(*Judged({.sensor_takes = "", .timing = chain("")}).reading.model, none);
  EXPECT_TRUE(none.sorted().empty());
}

/// The conduct of the line follower with another receive of the motor.
Conduct conduct(const std::string& timeout, const std::string& motor = "rate: 50 Hz") {
  const Judged judged({.motor = motor,
                       .motion = "{ from: \"robot.control.motion\", to: \"robot.motor.motion\", receive: "
                                 "blocking" +
                                 timeout + " }"});
  EXPECT_TRUE(judged.reading.model) << judged.reading.report();
  return conduct_of(judged.declared, Bounds(judged.declared.system));
}

TEST(Conduct, TellsRatesWaitsTimeoutsAndStale) {
  const Conduct all = conduct(", timeout: 200 ms", "rate: 50 Hz, stale: 500 ms");
  ASSERT_EQ(all.rates.size(), 3U);
  int kept = 0;
  for (const RateVerdict& rate : all.rates) {
    kept += rate.keeps ? 1 : 0;
    EXPECT_FALSE(rate.may_overrun);
    if (rate.keeps) continue;
    // Every 40 or 60 ms.
    EXPECT_EQ(rate.longest, 60 * ms);
    EXPECT_EQ(rate.period, 20 * ms);
    EXPECT_NE(rate.waits_for, rate.subsystem);
  }
  EXPECT_EQ(kept, 2);
  ASSERT_EQ(all.waits.size(), 1U);
  EXPECT_TRUE(all.waits[0].receives);
  EXPECT_EQ(all.waits[0].longest, 55 * ms);
  EXPECT_EQ(all.waits[0].fires, Fires::never);
  ASSERT_EQ(all.stale.size(), 1U);
  EXPECT_EQ(all.stale[0].fires, Fires::never);
  EXPECT_LE(all.stale[0].oldest, 78 * ms);
}

/// The verdicts on that timeout, and that `stale`, of the motor.
std::pair<Fires, Fires> fire(const std::string& timeout, const std::string& stale,
                             const std::string& motor = "rate: 50 Hz, ") {
  const Conduct all = conduct(", timeout: " + timeout, motor + "stale: " + stale);
  EXPECT_EQ(all.waits.size(), 1U);
  EXPECT_EQ(all.stale.size(), 1U);
  return {all.waits.at(0).fires, all.stale.at(0).fires};
}

TEST(Conduct, ATimeoutNeverMayOrMustFire) {
  // Values come every 44 to 56 ms, and are read by then. If no timeout fired, the motor would begin every 40 or 60 ms,
  // and wait at least 40 ms for each value that comes before 60 ms have passed.
  EXPECT_EQ(fire("56 ms", "78 ms"), std::pair(Fires::never, Fires::never));
  EXPECT_EQ(fire("55 ms", "77 ms"), std::pair(Fires::may, Fires::may));
  EXPECT_EQ(fire("40 ms", "50 ms"), std::pair(Fires::may, Fires::may));
  EXPECT_EQ(fire("39 ms", "44 ms"), std::pair(Fires::must, Fires::may));
  EXPECT_EQ(fire("1 ms", "43 ms"), std::pair(Fires::must, Fires::must));
  // Without a rate, it waits 50 ms less its call on average.
  EXPECT_EQ(fire("47 ms", "43 ms", "").first, Fires::must);
  EXPECT_EQ(fire("48 ms", "43 ms", "").first, Fires::may);
}

TEST(Conduct, AWaitThatIsEndedByItsTimeoutLastsNoLonger) {
  const Conduct all = conduct(", timeout: 30 ms");
  ASSERT_EQ(all.waits.size(), 1U);
  EXPECT_EQ(all.waits[0].longest, 30 * ms);
  EXPECT_EQ(all.waits[0].certain, 40 * ms);
}

TEST(Conduct, ADrivenSubsystemKeepsTheRateOfItsSource) {
  const Judged judged(
      {.sensor = "rate: 50 Hz",
       .control = "rate: 50 Hz",
       .line = "{ from: \"robot.sensor.line\", to: \"robot.control.line\", receive: blocking }"});
  ASSERT_TRUE(judged.reading.model) << judged.reading.report();
  for (const RateVerdict& rate : conduct_of(judged.declared, Bounds(judged.declared.system)).rates) {
    EXPECT_TRUE(rate.keeps) << rate.subsystem;
    EXPECT_EQ(rate.longest, 20 * ms) << rate.subsystem;
  }
}

TEST(Conduct, IsToldOfARingInWhichNothingSaysWhatItTakes) {
  System ring{{{.sends = {0}, .receives = {1}}, {.sends = {1}, .receives = {0}}},
              {{0, 1, false, true}, {1, 0, false, true}}};
  for (Subsystem& one : ring.subsystems) one.shortest = 0, one.longest = unbounded;
  const Bounds bounds(ring);
  const Certain certain(bounds);
  EXPECT_EQ(certain.wait(bounds.occurrences().events().read(0)), 0);
  EXPECT_FALSE(certain.gets_stale(0, 1));
}

TEST(Drift, NamesARateThatGoesIntoTheOthers) {
  const auto drift = [](const std::string& sensor) {
    const Judged judged({.sensor = "rate: " + sensor, .motion = no_waits});
    EXPECT_TRUE(judged.reading.model) << judged.reading.report();
    return drift_of(Bounds(judged.declared.system), judged.declared.chains.at(0).ways.at(0));
  };
  EXPECT_FALSE(drift("50 Hz"));
  EXPECT_FALSE(drift("31.25 Hz"));
  const auto camera = drift("30 Hz");
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->period, 33'333'333);
  EXPECT_THAT(camera->better, ElementsAre(25 * ms, 50 * ms));
  // No other rate, no drift; two are enough.
  EXPECT_THAT(drift("7 Hz")->better, ElementsAre(100 * ms, 200 * ms));
}

TEST(Conduct, ACallLongerThanThePeriodMayOverrun) {
  Follower slow{.motion = no_waits, .sensor_takes = "takes: 1..30 ms,"};
  const Judged judged(slow);
  ASSERT_TRUE(judged.reading.model) << judged.reading.report();
  const Conduct all = conduct_of(judged.declared, Bounds(judged.declared.system));
  EXPECT_EQ(std::ranges::count(all.rates, true, &RateVerdict::may_overrun), 1);
}

}  // namespace
}  // namespace tessera::timing
