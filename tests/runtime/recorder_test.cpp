#include "recorder/recorder.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// The recording of a short run that also logs.
[[nodiscard]] std::string make_recording(TestSystem& system) {
  Script script;
  script.call = [](ScriptState& state) {
    state.context.log("a line of text that needs more than one event");
  };
  system.add("robot.a", nets::alone, script, 10ms);
  RunOptions options = simulated(55ms);
  options.recording = scratch_file("run");
  EXPECT_FALSE(run(system, options).failed);
  return file_bytes(options.recording);
}

[[nodiscard]] std::optional<Recording> read_bytes(const std::string& bytes) {
  const std::string file = scratch_file("read");
  std::ofstream(file, std::ios::binary) << bytes;
  std::string error;
  return read_recording(file, error);
}

TEST(Recording, ATruncatedTailLosesOnlyItself) {
  TestSystem system;
  const std::string bytes = make_recording(system);
  const auto whole = read_bytes(bytes);
  ASSERT_TRUE(whole);
  EXPECT_FALSE(whole->truncated);
  std::size_t events = 0;
  const std::size_t header = bytes.find("robot.a.t_in");
  for (std::size_t size = bytes.size() / 2; size < bytes.size(); ++size) {
    if (size < header + 600) continue;
    const auto cut = read_bytes(bytes.substr(0, size));
    if (!cut) continue;
    EXPECT_TRUE(cut->truncated);
    EXPECT_GE(cut->entries.size(), events);
    events = cut->entries.size();
    for (std::size_t index = 0; index < events; ++index)
      EXPECT_EQ(cut->entries[index].text, whole->entries[index].text);
    EXPECT_EQ(complaint_about(*cut, system.system()), "");
  }
  EXPECT_EQ(events, whole->entries.size());  // only the event that says the end is missing
}

TEST(Recording, WhatIsNoneIsRefusedWithoutACrash) {
  TestSystem system;
  const std::string bytes = make_recording(system);
  EXPECT_FALSE(read_bytes(""));
  EXPECT_FALSE(read_bytes("TESSREC1"));
  EXPECT_FALSE(read_bytes("something else entirely"));
  std::string huge_header = bytes;
  huge_header.replace(8, 4, "\xff\xff\xff\xff");
  EXPECT_FALSE(read_bytes(huge_header));
  std::string other_json = bytes;
  other_json[12] = '[';
  EXPECT_FALSE(read_bytes(other_json));
  std::string error;
  EXPECT_FALSE(read_recording("/nonexistent", error));
  EXPECT_EQ(error, "cannot read '/nonexistent'");
}

TEST(Recording, OfANewerVersionIsRefusedByThatName) {
  TestSystem system;
  std::string bytes = make_recording(system);
  for (const char version : {'1', '2', '9', '0', 'x'}) {
    bytes[7] = version;
    RecordingReader reader;
    reader.feed(bytes);
    EXPECT_EQ(reader.problem().value_or(Problem{}).text,
              version == '1'                     ? ""
              : version == 'x' || version == '0' ? "is no recording of Tessera"
                                                 : "was recorded by a newer version of Tessera, which has to "
                                                   "read it");
  }
}

TEST(Recording, DamagedEventsEndItThere) {
  TestSystem system;
  std::string bytes = make_recording(system);
  const auto whole = read_bytes(bytes);
  ASSERT_TRUE(whole);
  // "duration" ends the file: one event, one of text and one that marks the end. The event before them
  // gets an impossible transition.
  std::string damaged = bytes;
  damaged.replace(bytes.size() - 4 * sizeof(Event) + 8, 4, "\xff\xff\xff\x7f");
  const auto read = read_bytes(damaged);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->truncated);
  EXPECT_EQ(read->entries.size(), whole->entries.size() - 2);
}

TEST(Oracle, ComplainsAboutARecordingThatIsNoFiringSequence) {
  TestSystem system;
  const auto recording = read_bytes(make_recording(system));
  ASSERT_TRUE(recording);
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
  for (const char* clock : {"simulated", "steady"}) {
    Recording missing = *recording;
    missing.clock = clock;
    missing.entries.erase(missing.entries.begin() + 8);
    EXPECT_NE(complaint_about(missing, system.system()), "") << clock;
  }
}

TEST(Recorder, AFullRingLosesEventsAndCountsThem) {
  RecordingFile file;
  std::string error;
  ASSERT_TRUE(file.open(scratch_file("ring"), {"{}"}, error)) << error;
  RecordingLane lane(0, file, 8);
  for (std::uint32_t event = 0; event < 12; ++event) lane.firing(Time{}, event, 0);
  EXPECT_EQ(lane.lost(), 4u);
  lane.drain();
  lane.text(Event::Kind::log, Time{}, 0, "longer than there is room: " + std::string(200, 'x'));
  EXPECT_EQ(lane.lost(), 5u);
  lane.firing(Time{}, 12, 0);
  EXPECT_EQ(lane.lost(), 5u);
}

TEST(Recorder, AFullDiskIsAWarningAndNoMore) {
  for (const RunOptions::Clock clock : {RunOptions::Clock::simulated, RunOptions::Clock::steady}) {
    TestSystem system;
    system.add("robot.a", nets::alone, {}, 1ms);
    RunOptions options = simulated(50ms);
    options.clock = clock;
    options.recording = "/dev/full";
    const RunSummary summary = run(system, options);
    EXPECT_FALSE(summary.failed);
    EXPECT_EQ(summary.ended, "duration");
    EXPECT_GT(summary.lost_events, 0u);
    ASSERT_EQ(summary.warnings.size(), 1u);
    EXPECT_EQ(summary.warnings[0], "the recording '/dev/full' is cut: No space left on device");
  }
}

TEST(Recorder, AFileThatCannotBeCreatedIsSaidBeforeTheRun) {
  TestSystem system;
  system.add("robot.a", nets::alone, {}, 1ms);
  RunOptions options = simulated(50ms);
  options.recording = "/nonexistent/run";
  std::string error;
  EXPECT_FALSE(execute(system.system(), options, error));
  EXPECT_EQ(error, "cannot record to '/nonexistent/run': No such file or directory");
}

TEST(Recorder, TwoRunsDoNotRecordIntoOneFile) {
  TestSystem system;
  system.add("robot.a", nets::alone, {}, 1ms);
  RunOptions options = simulated(50ms);
  options.recording = scratch_file("shared");
  RecordingFile first;
  const RecordingHeader header{.json = "{\"mine\":1}"};
  std::string error;
  ASSERT_TRUE(first.open(options.recording, header, error, {}, nullptr)) << error;
  const std::string before = file_bytes(options.recording);
  ASSERT_NE(before, "");

  EXPECT_FALSE(execute(system.system(), options, error));
  EXPECT_EQ(error,
            "another run records into '" + options.recording + "'\nhint: name another file with --record");
  EXPECT_EQ(file_bytes(options.recording), before);
  first.close();
  EXPECT_TRUE(execute(system.system(), options, error)) << error;
  EXPECT_TRUE(read_recording(options.recording, error)) << error;
}

}  // namespace
}  // namespace tessera::testing
