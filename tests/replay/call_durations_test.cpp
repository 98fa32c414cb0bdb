#include "replay/times/call_durations.hpp"

#include <gtest/gtest.h>

#include "constructed.hpp"

namespace tessera::replay {
namespace {

constexpr std::int64_t one_ms = 1'000'000;

Recording with_sequence(Recording recording) {
  std::map<std::uint32_t, std::uint32_t> next;
  for (Recording::Entry& entry : recording.entries) entry.event.sequence = next[entry.event.instance()]++;
  return recording;
}

Constructed control() {
  Constructed run({"robot.control", "robot.motor"});
  run.recording.behaviours = {{"go"}, {"drive"}};
  return run;
}

TEST(CallDurations, AreFromTheCallToT1OfEachBehaviour) {
  Constructed run = control();
  run.call(1.0, 0).fire(1.25, 0, "go.t1").fire(1.5, 0, "go.t4").call(2.0, 0).call(2.1, 1);
  run.fire(2.2, 1, "drive.t1").fire(2.5, 0, "go.t1").call(3, 0);
  DurationsOfBehaviours all;
  add_durations(with_sequence(run.recording), all);
  ASSERT_EQ(all.size(), 2U);
  const CallDurations& go = all.at({"robot.control", "go"});
  EXPECT_EQ(go.count, 2U);
  EXPECT_EQ(go.least_ns, 250 * one_ms);
  EXPECT_EQ(go.most_ns, 500 * one_ms);
  EXPECT_EQ(go.most_at_ns, 2000 * one_ms);
  EXPECT_EQ(all.at({"robot.motor", "drive"}).count, 1U);
  add_durations(with_sequence(run.recording), all);
  EXPECT_EQ(all.at({"robot.control", "go"}).count, 4U);
  EXPECT_EQ(all.at({"robot.control", "go"}).least_ns, 250 * one_ms);
}

TEST(CallDurations, LeaveOutCallsThatFailedAndThoseOfWhichEventsAreLost) {
  Constructed run = control();
  run.call(1.0, 0).fire(1.25, 0, "go.t1").call(2.0, 0).log(2.5, 0, 0, "lost").fire(3.5, 0, "go.t1");
  run.call(4, 0).log(4.5, 0, 0, "fails").fire(6, 0, "go.t1");
  Recording recording = with_sequence(run.recording);
  for (Recording::Entry& entry : recording.entries)
    if (entry.text == "fails") entry.event.origin = static_cast<std::uint32_t>(Event::Kind::fault);
  std::erase_if(recording.entries, [](const auto& entry) { return entry.text == "lost"; });
  DurationsOfBehaviours all;
  add_durations(recording, all);
  const CallDurations& go = all.at({"robot.control", "go"});
  EXPECT_EQ(go.count, 1U);
  EXPECT_EQ(go.most_ns, 250 * one_ms);
  EXPECT_EQ(go.failed, 1U);
}

TEST(CallDurations, HoldCallsOfWhichOvertimeIsOnlyTold) {
  for (const bool told : {true, false}) {
    Constructed run = control();
    run.call(1.0, 0).log(1.2, 0, 0, "overtime").fire(1.25, 0, "go.t1");
    Recording recording = with_sequence(run.recording);
    for (Recording::Entry& entry : recording.entries)
      if (entry.text == "overtime") {
        entry.event.origin = static_cast<std::uint32_t>(Event::Kind::fault);
        entry.event.version = static_cast<std::uint32_t>(Fault::overtime) | (told ? told_fault : 0U);
        EXPECT_EQ(entry.event.fault(), Fault::overtime);
        EXPECT_EQ(entry.event.is_told_fault(), told);
      }
    DurationsOfBehaviours all;
    add_durations(recording, all);
    EXPECT_EQ(all.at({"robot.control", "go"}).count, told ? 1U : 0U);
    EXPECT_EQ(all.at({"robot.control", "go"}).failed, told ? 0U : 1U);
  }
}

}  // namespace
}  // namespace tessera::replay
