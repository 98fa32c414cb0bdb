// Ages and reactions of runs that are written by hand.
#include "replay/times/ages.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "replay/times/recorded_way.hpp"

namespace tessera::replay {
namespace {

constexpr std::int64_t ms = 1'000'000;

/// A sensor, a control subsystem and a motor; times in milliseconds. Each member adds one event.
class WrittenRun {
 public:
  Recording recording;

  WrittenRun() {
    recording.instances = {"robot.sensor", "robot.control", "robot.motor"};
    recording.channels = {"line", "motion"};
    for (std::uint32_t subsystem = 0; subsystem < 3; ++subsystem) {
      recording.transitions.push_back({"start", subsystem, {.step = Step::start}});
      recording.transitions.push_back({"t1", subsystem, {.step = Step::begin_sending}});
      recording.transitions.push_back({"t4", subsystem, {.step = Step::go_on}});
      for (const Step step : {Step::transfer, Step::overwrite, Step::skip, Step::timeout})
        for (std::uint32_t channel = 0; channel < 2; ++channel)
          recording.transitions.push_back({"block", subsystem, {.step = step, .channel = channel}});
    }
  }

  WrittenRun& add(std::int64_t at_ms, std::uint32_t subsystem, Event::Kind kind, std::uint32_t subject = 0,
                  std::uint32_t version = 0, const std::string& text = {}) {
    recording.entries.push_back({{.time_ns = at_ms * ms,
                                  .subject = subject,
                                  .version = version,
                                  .sequence = next_[subsystem]++,
                                  .origin = subsystem * 256 + static_cast<std::uint32_t>(kind)},
                                 text});
    return *this;
  }
  WrittenRun& fire(std::int64_t at_ms, std::uint32_t subsystem, Step step, std::uint32_t channel = 0,
                   std::uint32_t version = 0) {
    for (std::uint32_t subject = 0; subject < recording.transitions.size(); ++subject) {
      const Recording::Transition& one = recording.transitions[subject];
      if (one.instance == subsystem && one.role.step == step && one.role.channel.value_or(channel) == channel)
        return add(at_ms, subsystem, Event::Kind::firing, subject, version);
    }
    return *this;
  }
  WrittenRun& start() {
    for (std::uint32_t subsystem = 0; subsystem < 3; ++subsystem) fire(0, subsystem, Step::start);
    return *this;
  }
  WrittenRun& call(std::uint32_t subsystem, std::int64_t from_ms, std::int64_t to_ms) {
    return add(from_ms, subsystem, Event::Kind::call).fire(to_ms, subsystem, Step::begin_sending);
  }
  /// Both firings of an end that moves a value.
  WrittenRun& move(std::int64_t at_ms, std::uint32_t subsystem, std::uint32_t channel,
                   std::uint32_t version) {
    return fire(at_ms, subsystem, Step::transfer, channel, version)
        .fire(at_ms, subsystem, Step::transfer, channel, version + 1);
  }
  WrittenRun& end(std::int64_t at_ms, std::uint32_t subsystem) { return fire(at_ms, subsystem, Step::go_on); }
  /// Loses the next event of the subsystem.
  WrittenRun& lose(std::uint32_t subsystem) {
    ++next_[subsystem];
    return *this;
  }

  /// Sensor reads at `read_ms`, control calculates 10 ms later, the motor 20 ms later; each call takes 2 ms.
  WrittenRun& pass(std::int64_t read_ms, std::uint32_t version) {
    call(0, read_ms, read_ms + 2).move(read_ms + 2, 0, 0, version).end(read_ms + 2, 0);
    move(read_ms + 5, 1, 0, version + 2).end(read_ms + 5, 1);
    call(1, read_ms + 10, read_ms + 12).move(read_ms + 12, 1, 1, version);
    move(read_ms + 15, 2, 1, version + 2).end(read_ms + 15, 2);
    call(2, read_ms + 20, read_ms + 22);
    return *this;
  }

 private:
  std::vector<std::uint32_t> next_{0, 0, 0};
};

ChainAges measured(const std::vector<Recording>& recordings) {
  Ages ages({{"robot.sensor -> robot.control -> robot.motor",
              "robot.sensor -> robot.control -> robot.motor",
              {"robot.sensor", "robot.control", "robot.motor"},
              {{"line", "motion"}}}});
  for (const Recording& recording : recordings) ages.add(recording);
  return ages.finish().at(0);
}

TEST(Ages, CountFromTheReadingToTheEndOfTheCommand) {
  WrittenRun run;
  run.start().pass(100, 1).pass(140, 5).pass(200, 9);
  const ChainAges ages = measured({run.recording});
  EXPECT_EQ(ages.age.count, 3U);
  EXPECT_EQ(ages.age.least, 22 * ms);
  EXPECT_EQ(ages.age.most, 22 * ms);
  EXPECT_EQ(ages.why, "");
  // An event just after the readings at 100 and 140 is answered at 162 and 222; that at 200 is not.
  EXPECT_EQ(ages.reaction.count, 2U);
  EXPECT_EQ(ages.reaction.least, 62 * ms);
  EXPECT_EQ(ages.reaction.most, 82 * ms);
  EXPECT_EQ(ages.reaction.worst_from_ns, 140 * ms);
  EXPECT_EQ(ages.reaction.worst_to_ns, 222 * ms);
}

TEST(Ages, ARepeatedCommandIsOfTheSameReading) {
  WrittenRun run;
  run.start().pass(100, 1).fire(125, 2, Step::skip, 1).end(125, 2).call(2, 150, 152);
  const ChainAges ages = measured({run.recording});
  EXPECT_EQ(ages.age.count, 2U);
  EXPECT_EQ(ages.age.most, 52 * ms);
}

TEST(Ages, CommandsBeforeTheFirstReadingHaveNone) {
  WrittenRun run;
  run.start().call(2, 0, 1).fire(1, 2, Step::timeout, 1).end(1, 2).pass(100, 1);
  EXPECT_EQ(measured({run.recording}).age.count, 1U);
}

TEST(Ages, AReceiveTakesTheNewestValueWhateverTheOrderInTheFile) {
  WrittenRun run;
  // The receiver's events stand before those of the sender, as a thread that writes late leaves them.
  run.start().move(36, 1, 0, 5).end(36, 1).call(1, 40, 42).move(42, 1, 1, 1);
  run.call(0, 10, 12).move(12, 0, 0, 1).end(12, 0);
  run.call(0, 30, 32).fire(32, 0, Step::overwrite, 0, 3).fire(32, 0, Step::transfer, 0, 4).end(32, 0);
  run.call(0, 50, 52).move(52, 0, 0, 7).end(52, 0);
  run.move(45, 2, 1, 3).end(45, 2).call(2, 60, 62);
  const ChainAges ages = measured({run.recording});
  EXPECT_EQ(ages.age.count, 1U);
  EXPECT_EQ(ages.age.most, 32 * ms);
  EXPECT_EQ(ages.reaction.worst_from_ns, 10 * ms);
  EXPECT_EQ(ages.reaction.most, 52 * ms);
}

TEST(Ages, VersionsBeginAgainAfterTheLargest) {
  WrittenRun run;
  run.start().pass(100, 0xfffffffd).pass(140, 2);
  EXPECT_EQ(measured({run.recording}).age.most, 22 * ms);
}

TEST(Ages, ACallThatFailedGivesNoCommandAndNoReading) {
  WrittenRun run;
  run.start().pass(100, 1);
  run.add(130, 0, Event::Kind::call)
      .add(131, 0, Event::Kind::fault, 0, static_cast<std::uint32_t>(Fault::device));
  run.fire(132, 0, Step::begin_sending).move(132, 0, 0, 5).end(132, 0);
  run.move(135, 1, 0, 7).end(135, 1).call(1, 140, 142).move(142, 1, 1, 5).end(142, 1);
  run.move(145, 2, 1, 7).end(145, 2).call(2, 150, 152).end(152, 2);
  run.add(160, 2, Event::Kind::safe, 0, static_cast<std::uint32_t>(SafeEvent::given),
          "robot.motor.left: stale");
  run.call(2, 170, 172);
  const ChainAges ages = measured({run.recording});
  EXPECT_EQ(ages.age.count, 2U);
  EXPECT_EQ(ages.age.most, 52 * ms);  // the outputs of the failed call are those of the one before
  EXPECT_EQ(ages.withheld, 1U);
}

TEST(Ages, TimesThatDependOnLostEventsAreLeftOut) {
  WrittenRun run;
  run.start().pass(100, 1);
  // The second value of the sensor is lost, and with it its reading; control receives it all the same.
  run.lose(0).move(145, 1, 0, 7).end(145, 1).call(1, 150, 152).move(152, 1, 1, 5).end(152, 1);
  run.add(146, 0, Event::Kind::log).move(155, 2, 1, 7).end(155, 2).call(2, 160, 162);
  run.pass(200, 11);
  const ChainAges ages = measured({run.recording});
  EXPECT_EQ(ages.age.count, 2U);
  EXPECT_EQ(ages.age.most, 22 * ms);
  EXPECT_EQ(ages.reaction.count, 0U);  // the first command after the reading at 100 is not known
}

TEST(Ages, ARecordingWithoutItsBeginningIsMeasuredFromItsFirstReadingOn) {
  WrittenRun whole, rest;
  whole.start().pass(100, 1).pass(140, 5).pass(200, 9);
  rest.recording = whole.recording;
  std::erase_if(rest.recording.entries, [](const auto& entry) { return entry.event.time_ns < 145 * ms; });
  const ChainAges ages = measured({rest.recording});
  EXPECT_EQ(ages.age.count, 1U);
  EXPECT_EQ(ages.age.worst_from_ns, 200 * ms);
}

TEST(Ages, OfSeveralRecordingsTheWorstSaysInWhich) {
  WrittenRun first, second, other;
  first.start().pass(100, 1);
  second.start().pass(100, 1).fire(125, 2, Step::skip, 1).end(125, 2).call(2, 150, 152);
  other.recording.instances = {"cart.wheel"};
  const ChainAges ages = measured({first.recording, second.recording, other.recording});
  EXPECT_EQ(ages.age.count, 3U);
  EXPECT_EQ(ages.age.worst_recording, 1U);
  EXPECT_EQ(measured({other.recording}).why, "the recording has no subsystem robot.sensor");
}

TEST(Ages, WithoutCallsItSaysHowToRecordThem) {
  WrittenRun run;
  run.start().fire(2, 0, Step::begin_sending).move(2, 0, 0, 1);
  const ChainAges ages = measured({run.recording});
  EXPECT_EQ(ages.age.count, 0U);
  EXPECT_NE(ages.why.find("--record-values small"), std::string::npos) << ages.why;
}

RecordedWay way_of(WrittenRun& run, const ExplainedTime& time) {
  run.recording.behaviours = {{"watch"}, {"follow"}, {"drive"}};
  RecordedWayReader reader(
      run.recording, {"", "", {"robot.sensor", "robot.control", "robot.motor"}, {{"line", "motion"}}}, time);
  for (const Recording::Entry& entry : run.recording.entries) reader.take(run.recording, entry);
  return reader.finish();
}

TEST(RecordedWay, TheValueOfACommandIsFollowedBackToItsReading) {
  WrittenRun run;
  run.start().pass(100, 1).pass(140, 5).fire(165, 2, Step::skip, 1).end(165, 2).call(2, 170, 172);
  const RecordedWay way = way_of(run, {ExplainedTime::Of::age, 140 * ms, 172 * ms});
  ASSERT_EQ(way.hops.size(), 2U);
  EXPECT_EQ(way.hops[0].channel, "line");
  EXPECT_EQ(way.hops[0].from, "robot.sensor");
  EXPECT_EQ(way.hops[0].to, "robot.control");
  EXPECT_EQ(way.hops[0].written_ns, 142 * ms);
  EXPECT_EQ(way.hops[0].read_ns, 145 * ms);
  EXPECT_EQ(way.hops[1].written_ns, 152 * ms);
  EXPECT_EQ(way.hops[1].read_ns, 155 * ms);
  std::vector<std::string> calls;
  for (const RecordedWay::Call& call : way.calls) {
    calls.push_back(call.subsystem + "." + call.behaviour + " " + std::to_string(call.begin_ns / ms));
    EXPECT_EQ(call.end_ns - call.begin_ns, 2 * ms);
  }
  EXPECT_THAT(calls, testing::ElementsAre("robot.sensor.watch 140", "robot.control.follow 150",
                                          "robot.motor.drive 160", "robot.motor.drive 170"));
}

TEST(RecordedWay, AReactionGoesOverALaterReading) {
  WrittenRun run;
  run.start().pass(100, 1).pass(140, 5);
  const RecordedWay way = way_of(run, {ExplainedTime::Of::reaction, 100 * ms, 162 * ms});
  ASSERT_EQ(way.hops.size(), 2U);
  EXPECT_EQ(way.hops[0].written_ns, 142 * ms);
  EXPECT_EQ(way.calls.front().begin_ns, 100 * ms);
}

TEST(RecordedWay, LostEventsLeaveOnlyTheCalls) {
  WrittenRun run;
  run.start().pass(100, 1).lose(1).move(125, 2, 1, 7).end(125, 2).call(2, 150, 152);
  const RecordedWay way = way_of(run, {ExplainedTime::Of::age, 90 * ms, 152 * ms});
  EXPECT_TRUE(way.hops.empty());
  EXPECT_FALSE(way.calls.empty());
}

}  // namespace
}  // namespace tessera::replay
