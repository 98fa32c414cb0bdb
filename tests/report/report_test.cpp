#include "report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "constructed.hpp"
#include "report/charts.hpp"
#include "report/messages.hpp"
#include "report/text.hpp"

// fontconfig, which cairo uses for fonts, keeps its data until the process ends, which counts as a leak.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }

using namespace tessera::report;
using testing::HasSubstr;
using testing::Not;

namespace {

ReportInput run_without_a_track() {
  Constructed run({"robot.control", "robot.motor"});
  run.recording.system = "tester";
  run.recording.net_hash = "0123abcd";
  run.recording.clock = "simulated";
  for (std::uint32_t s : {0U, 1U}) run.fire(0, s, "t_in");
  for (int i = 0; i < 40; ++i) run.fire(i * 0.05, 0, "follow.t1").fire(i * 0.05, 1, "drive.t1");
  run.fire(2, 0, "follow.t6");
  run.log(1.5, 0, 1, "careful");
  return {.recording = run.recording,
          .simulated_s = 2,
          .wall_s = 0.01,
          .firings = 1234567,
          .ended = "time is up",
          .verdicts = {{"safe", "holds", "by invariants"}}};
}

ReportInput run_on_a_track() {
  ReportInput input = run_without_a_track();
  const auto floor = tessera::sim::Track::load(TESSERA_SOURCE_DIR "/share/tessera/tracks/oval.png", 0.005);
  if (!floor) throw std::runtime_error(floor.problem());
  tessera::sim::Trace trace;
  for (int i = 0; i < 30'000; ++i) {
    const double angle = i * 0.002;
    trace.points.push_back({.t_s = i * 0.01,
                            .x_m = 1.2 + 0.7 * std::cos(angle),
                            .y_m = 0.6 + 0.4 * std::sin(angle),
                            .heading_rad = angle,
                            .eye_x_m = 1.2 + 0.8 * std::cos(angle),
                            .eye_y_m = 0.6 + 0.5 * std::sin(angle),
                            .on_line = i % 1000 > 30});
  }
  const auto line = skeleton(*floor);
  input.drive = DrivenPath{*floor, line, trace, measure(line, trace)};
  return input;
}

TEST(Report, ShowsHowOldTheReadingsOfCommandsWereBesideTheBound) {
  ReportInput input = run_without_a_track();
  EXPECT_THAT(render(input)[0].bytes, Not(HasSubstr("Age of commands")));
  tessera::replay::MeasuredTimes times{100, 10'000'000, 20'000'000, 30'000'000, 35'000'000, 40'000'000,
                                       {},  {},         0,          0,          0};
  times.histogram = {90, 9, 1};
  ChainTimes chain{.name = "robot.eye -> robot.control -> robot.<motor>", .age = {times, 82'000'000}};
  input.chains = {chain};
  const std::string within = render(input)[0].bytes;
  EXPECT_THAT(within, HasSubstr("Age of commands"));
  EXPECT_THAT(within, HasSubstr("robot.&lt;motor&gt;"));
  EXPECT_THAT(within, HasSubstr("at most 82 ms"));
  EXPECT_THAT(within, HasSubstr("longest 40.000 ms"));
  EXPECT_THAT(within, Not(HasSubstr("above its bound")));
  EXPECT_THAT(within, Not(HasSubstr("reaction:")));  // there is none
  input.chains[0].age.bound_ns = 39'000'000;
  EXPECT_THAT(render(input)[0].bytes, HasSubstr("above its bound"));
  input.slow_calls = {{"robot.control.follow", 3, 500, 8'000'000, 9'100'000, 2'300'000'000}};
  EXPECT_THAT(render(input)[0].bytes, HasSubstr("Overtime"));
  EXPECT_THAT(render(input)[0].bytes, HasSubstr("9.100 ms"));
}

TEST(Report, WithATrackIsAPageAndAPicture) {
  const auto files = render(run_on_a_track());
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].name, "index.html");
  EXPECT_EQ(files[1].name, "path.png");
  EXPECT_EQ(files[1].bytes.substr(1, 3), "PNG");
  for (const char* part : {"<h2>Path</h2>", "<h2>Lateral error</h2>", "<h2>Behaviours</h2>", "laps",
                           "line lost", "data:image/png;base64,iVBOR"}) {
    EXPECT_THAT(files[0].bytes, HasSubstr(part));
  }
}

TEST(Report, WithoutATrackHasTimelineAndSummary) {
  const auto files = render(run_without_a_track());
  ASSERT_EQ(files.size(), 1U);
  const std::string& page = files[0].bytes;
  EXPECT_THAT(page, Not(HasSubstr("<h2>Path</h2>")));
  for (const char* part : {"<h2>Behaviours</h2>", "robot.control", "follow", "drive", "0123abcd", "careful",
                           "time is up", "by invariants", "1\u2009234\u2009567", "200 \u00d7"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
}

TEST(Report, OfNothingIsStillAPage) {
  const auto files = render({});
  ASSERT_EQ(files.size(), 1U);
  EXPECT_THAT(files[0].bytes, HasSubstr("</html>"));
}

TEST(Report, WithoutALineOrAPathIsStillAPage) {
  ReportInput no_line = run_on_a_track();
  no_line.drive->line = {};
  no_line.drive->metrics = measure({}, no_line.drive->trace);
  EXPECT_THAT(render(no_line)[0].bytes, Not(HasSubstr("<h2>Lateral error</h2>")));
  ReportInput no_path = run_on_a_track();
  no_path.drive->trace = {};
  no_path.drive->metrics = {};
  EXPECT_EQ(render(no_path).size(), 2U);
}

TEST(Report, NeedsNothingButItself) {
  const std::string page = render(run_on_a_track())[0].bytes;
  for (const char* part : {"http:", "https:", "<script", "url(", "<link"})
    EXPECT_THAT(page, Not(HasSubstr(part)));
}

TEST(Report, TheSameInputGivesTheSameBytes) {
  const auto first = render(run_on_a_track());
  const auto second = render(run_on_a_track());
  EXPECT_EQ(first[0].bytes, second[0].bytes);
  EXPECT_EQ(first[1].bytes, second[1].bytes);
}

TEST(Report, TextFromOutsideIsEscaped) {
  const std::string evil = "<img src=x onerror=\"alert('1')\">&";
  Constructed run({evil});
  run.recording.system = evil;
  run.recording.net_hash = evil;
  run.fire(0, 0, "t_in").fire(0, 0, evil + ".t1").fire(1, 0, "t_" + evil + "_1").log(1, 0, 2, evil);
  const ReportInput input{.recording = run.recording,
                          .ended = evil,
                          .subsystems = {{evil, 1, 2, 3}},
                          .verdicts = {{evil, evil, evil}}};
  const std::string page = render(input)[0].bytes;
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, HasSubstr("&lt;img src=x onerror=&quot;alert(&#39;1&#39;)&quot;&gt;&amp;"));
}

TEST(Report, ControlCharactersDoNotReachThePage) {
  EXPECT_EQ(escaped(std::string("a\0b\x1b", 4)),
            "a\xef\xbf\xbd"
            "b\xef\xbf\xbd");
}

TEST(Report, DataUrisAreBase64) {
  EXPECT_EQ(data_uri("text/plain", ""), "data:text/plain;base64,");
  EXPECT_EQ(data_uri("text/plain", "f"), "data:text/plain;base64,Zg==");
  EXPECT_EQ(data_uri("text/plain", "fo"), "data:text/plain;base64,Zm8=");
  EXPECT_EQ(data_uri("text/plain", "foob"), "data:text/plain;base64,Zm9vYg==");
  EXPECT_EQ(data_uri("a/b", "\xff\xfe\xfd"), "data:a/b;base64,//79");
}

TEST(Report, WhatIsNoUtf8OrTurnsTheDirectionOfWritingDoesNotReachThePage) {
  const std::string bad = "\xef\xbf\xbd";
  EXPECT_EQ(escaped("gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\xa4\x96"),
            "gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\xa4\x96");
  EXPECT_EQ(escaped("a\xff"
                    "b\xc3"),
            "a" + bad + "b" + bad);
  EXPECT_EQ(escaped("\xc0\xaf\xed\xa0\x80"), bad + bad + bad + bad + bad);
  EXPECT_EQ(escaped("\xe2\x80\xae\xc2\x9b"), bad + bad);
}

TEST(Report, ShortenedTextKeepsWholeCharacters) {
  EXPECT_EQ(shortened("short", 10, 2), "short");
  EXPECT_EQ(shortened("a\xc3\xbc"
                      "b",
                      2, 2),
            "a \u2026");
  EXPECT_EQ(shortened("1\n2\n3\n4", 100, 2), "1\n2 \u2026");
}

TEST(Report, OnlyTextsAreMessages) {
  Constructed run({"robot.control"});
  run.value(0.1, 0, 0, 0, std::string("\x01\x02\xff\x00garbage", 11)).log(0.2, 0, 0, "a line");
  run.recording.entries.push_back(
      {{.subject = 3, .origin = 0xffffffU << 8U | static_cast<std::uint32_t>(tessera::Event::Kind::marking)},
       "p.q"});
  const Messages messages = messages_of(run.recording, 10);
  ASSERT_EQ(messages.shown.size(), 1U);
  EXPECT_EQ(messages.shown[0].what, "a line");
  EXPECT_EQ(messages.hidden, 0U);
  const std::string page = render({.recording = run.recording})[0].bytes;
  EXPECT_THAT(page, Not(HasSubstr("garbage")));
  EXPECT_THAT(page, Not(HasSubstr("\xef\xbf\xbd")));
}

TEST(Report, OfManyMessagesTheMostImportantAreShownAndEqualOnesAreOne) {
  Constructed run({"robot.control"});
  for (int i = 0; i < 1000; ++i) run.log(i * 0.01, 0, 0, "line " + std::to_string(i));
  for (int i = 0; i < 500; ++i) run.log(i * 0.02, 0, 1, "again");
  run.log(5, 0, 2, "the motor burns");
  const Messages messages = messages_of(run.recording, 10);
  ASSERT_EQ(messages.shown.size(), 10U);
  EXPECT_EQ(messages.hidden, 1000U - 8U);
  const auto shown = [&](const std::string& what) {
    for (const Message& message : messages.shown)
      if (message.what == what) return message.count;
    return std::uint64_t{0};
  };
  EXPECT_EQ(shown("the motor burns"), 1U);
  EXPECT_EQ(shown("again"), 500U);
  EXPECT_EQ(shown("line 0"), 1U);
  EXPECT_EQ(shown("line 999"), 1U);
  EXPECT_THAT(render({.recording = run.recording})[0].bytes, HasSubstr("more messages"));
}

TEST(Report, SaysWhatARecordingDoesNotHold) {
  ReportInput input = run_without_a_track();
  EXPECT_THAT(render(input)[0].bytes, Not(HasSubstr("notice\">")));
  input.recording.truncated = true;
  input.recording.lost = 12;
  input.paths.emplace();
  const std::string page = render(input)[0].bytes;
  EXPECT_THAT(page, HasSubstr("cut off at its end"));
  EXPECT_THAT(page, HasSubstr("12 events of the run are missing"));
  EXPECT_THAT(page, HasSubstr("no poses of the bodies of the world, so there are no paths"));
}

TEST(Report, OfARecordingWithoutItsBeginningDoesNotTellWhatNeedsTheWhole) {
  ReportInput input = run_on_a_track();
  for (const char* of_the_whole : {" laps", "line lost (longest", "\u00b7 line lost", "mean error"})
    EXPECT_THAT(render(input)[0].bytes, HasSubstr(of_the_whole));
  input.recording.segment = 3;
  for (tessera::Recording::Entry& entry : input.recording.entries) entry.event.time_ns += 70'000'000'000;
  input.drive->is_whole = false;
  const std::string page = render(input)[0].bytes;
  EXPECT_THAT(page, HasSubstr("its beginning is gone: it holds what happened from 70.000 s on"));
  EXPECT_THAT(page, HasSubstr("--record-limit none"));
  EXPECT_THAT(page, Not(HasSubstr(" laps")));
  EXPECT_THAT(page, Not(HasSubstr("line lost (longest")));
  EXPECT_THAT(page, Not(HasSubstr("\u00b7 line lost")));
  EXPECT_THAT(page, Not(HasSubstr("mean error")));
}

TEST(Report, OfARunWithoutDurationHasNoEmptyChart) {
  Constructed run({"robot.control"});
  run.fire(0, 0, "t_in").fire(0, 0, "follow.t1");
  EXPECT_THAT(render({.recording = run.recording})[0].bytes, Not(HasSubstr("<svg")));
}

TEST(Report, OfAFailedRunSaysSoAboveTheFigures) {
  ReportInput input = run_without_a_track();
  EXPECT_THAT(render(input)[0].bytes, Not(HasSubstr("has failed")));
  input.recording.entries.push_back(
      {{.version = 1, .origin = 0xffffffU << 8U | static_cast<std::uint32_t>(tessera::Event::Kind::stop)},
       "x"});
  input.ended = "the <motor> burns";
  EXPECT_THAT(render(input)[0].bytes, HasSubstr("The run has failed: the &lt;motor&gt; burns"));
}

TEST(Report, OfALargeFleetStaysShortAndShowsThoseWithErrors) {
  std::vector<std::string> paths;
  for (int robot = 0; robot < 200; ++robot) paths.push_back("robot[" + std::to_string(robot) + "].control");
  Constructed run(paths);
  for (std::uint32_t robot = 0; robot < 200; ++robot) run.fire(0, robot, "t_in").fire(1, robot, "go.t1");
  run.fire(2, 150, "go.t6");
  const std::string page = render({.recording = run.recording})[0].bytes;
  EXPECT_THAT(page, HasSubstr("robot[150].control"));
  EXPECT_THAT(page, Not(HasSubstr("robot[149].control")));
  EXPECT_THAT(page, HasSubstr("and 176 more subsystems"));
}

TEST(Report, OfALongRunStaysSmall) {
  ReportInput input = run_on_a_track();
  Constructed run({"a.b"});
  run.fire(0, 0, "t_in");
  for (int i = 0; i < 100'000; ++i)
    run.fire(i * 0.01, 0, "one.t1")
        .fire(i * 0.01, 0, "one.t6")
        .fire(i * 0.01, 0, "t_one_1")
        .log(i * 0.01, 0, 0, "again and again: " + std::to_string(i));
  input.recording = run.recording;
  const std::string page = render(input)[0].bytes;
  EXPECT_LT(page.size(), 1'500'000U);
  EXPECT_THAT(page, HasSubstr("and 99\u2009960 more messages"));
}

}  // namespace
