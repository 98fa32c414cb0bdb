#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "nets.hpp"
#include "recorder/marking_track.hpp"
#include "recorder/recorder.hpp"
#include "rerun/rerun.hpp"
#include "system/console.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;
namespace fs = std::filesystem;

namespace tessera::testing {
namespace {

/// A ring of two that exchange values and a third one that logs.
void make_talkers(TestSystem& system) {
  Script counts, logs;
  counts.call = [](ScriptState& state) { state.out_x = static_cast<double>(state.context.iteration); };
  logs.call = [](ScriptState& state) { state.context.log("iteration {}", state.context.iteration); };
  const auto a = system.add("robot.a", nets::b_sender, counts, 1ms);
  const auto b = system.add("robot.b", nets::b_receiver_ack, {});
  const auto c = system.add("robot.c", nets::async_relay, counts, 1ms);
  const auto d = system.add("robot.d", nets::async_receiver, logs, 5ms);
  const auto e = system.add("robot.e", nets::async_sender, counts, 2ms);
  system.connect(a, "x", b, "x", acknowledged);
  system.connect(c, "out", d, "x", asynchronous);
  system.connect(e, "x", c, "in", asynchronous);
}

struct RecordedRun {
  std::string file;
  RunSummary summary;
};

[[nodiscard]] RecordedRun recorded(RunOptions options, std::uint64_t segment_bytes, std::uint32_t segments) {
  TestSystem system;
  make_talkers(system);
  options.recording = scratch_file("run.tsr");
  options.record_limit = {segment_bytes, segments};
  console::silence(true);
  RunSummary summary = run(system, options);
  console::silence(false);
  return {options.recording, std::move(summary)};
}

[[nodiscard]] Recording recording_in(const std::string& file) {
  std::string error;
  auto recording = read_recording(file, error);
  EXPECT_TRUE(recording) << error;
  return recording.value_or(Recording{});
}

[[nodiscard]] std::size_t bytes_in(const fs::path& folder) {
  std::size_t bytes = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) bytes += entry.file_size();
  return bytes;
}

TEST(Segments, AreReadAsOneRecording) {
  const RecordedRun limited = recorded(simulated(300ms), 40'000, 1000);
  const Recording all = recording_in(limited.file);
  EXPECT_EQ(all.segment, 0U);
  EXPECT_EQ(limited.summary.recorded_from, std::nullopt);
  EXPECT_EQ(note_on_beginning(all), "");
  std::size_t markings = 0, others = 0;
  for (const Recording::Entry& entry : all.entries)
    ++(entry.event.kind() == Event::Kind::marking ? markings : others);
  EXPECT_GT(markings, 5U);

  TestSystem system;
  make_talkers(system);
  RunOptions options = simulated(300ms);
  options.recording = scratch_file("whole");
  console::silence(true);
  static_cast<void>(run(system, options));
  console::silence(false);
  EXPECT_EQ(others, recording_in(options.recording).entries.size());

  std::string error;
  const auto report = rerun(system.system(), {}, limited.file, error);
  ASSERT_TRUE(report) << error;
  EXPECT_FALSE(report->first) << rerun_text(*report);
}

TEST(Segments, OnlyTheNewestAreKeptAndTheyKeepToTheLimit) {
  const RecordedRun limited = recorded(simulated(2s), 50'000, 3);
  EXPECT_LE(bytes_in(fs::path(limited.file).parent_path()), 3 * 50'000U);
  EXPECT_GE(bytes_in(fs::path(limited.file).parent_path()), 2 * 50'000U);
  const Recording all = recording_in(limited.file);
  EXPECT_GT(*all.segment, 10U);
  EXPECT_EQ(all.entries.front().event.kind(), Event::Kind::marking);
  EXPECT_EQ(all.entries.back().text, "duration");
  const std::string from =
      fmt::format("{:.3f} s", static_cast<double>(all.entries.front().event.time_ns) * 1e-9);
  EXPECT_EQ(limited.summary.recorded_from, Duration(all.entries.front().event.time_ns));
  EXPECT_THAT(limited.summary.warnings,
              ::testing::ElementsAre(::testing::HasSubstr("the recording begins at " + from)));
  EXPECT_THAT(note_on_beginning(all), ::testing::HasSubstr("what happened from " + from));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(fs::path(limited.file).parent_path()))
    ++files;
  EXPECT_EQ(files, 3U);

  TestSystem system;
  make_talkers(system);
  std::string error;
  EXPECT_FALSE(rerun(system.system(), {}, limited.file, error));
  EXPECT_NE(error.find("its beginning is gone"), std::string::npos) << error;
}

/// Each firing must be enabled where it stands.
[[nodiscard]] std::string complaint_in_order(const Recording& recording, const System& system) {
  const FlatNet net = net_of(system);
  std::map<std::string, bool> marked;
  bool known = *recording.segment == 0;
  for (const FlatNet::FlatPlace& place : net.places) marked[place.name] = place.tokens > 0;
  for (const Recording::Entry& entry : recording.entries) {
    if (entry.event.kind() == Event::Kind::marking) {
      std::map<std::string, bool> written;
      for (const FlatNet::FlatPlace& place : net.places) written[place.name] = false;
      std::istringstream lines(entry.text);
      for (std::string line; std::getline(lines, line);) written.at(line) = true;
      if (known && written != marked) return "another marking";
      known = true;
      marked = written;
    }
    if (entry.event.kind() != Event::Kind::firing) continue;
    if (!known) return "no marking";
    for (const std::uint32_t place : net.transitions[entry.event.subject].inputs)
      if (!std::exchange(marked.at(net.places[place].name), false))
        return net.transitions[entry.event.subject].name + " was not enabled";
    for (const std::uint32_t place : net.transitions[entry.event.subject].outputs)
      marked.at(net.places[place].name) = true;
  }
  return "";
}

TEST(Segments, BeginWithTheirMarkingAndAreFiringSequencesByThemselves) {
  for (const RunOptions& options : {simulated(500ms), steady(500ms)}) {
    const RecordedRun limited = recorded(options, 30'000, 4);
    EXPECT_EQ(limited.summary.lost_events, 0U);
    TestSystem system;
    make_talkers(system);
    const Recording all = recording_in(limited.file);
    EXPECT_GT(*all.segment, 0U);
    EXPECT_EQ(complaint_in_order(all, system.system()), "");
    for (std::uint64_t number = *all.segment; number < *all.segment + 3; ++number) {
      const Recording one = recording_in(segment_path(limited.file, number));
      EXPECT_EQ(one.segment, number);
      EXPECT_EQ(complaint_in_order(one, system.system()), "");
    }
  }
}

TEST(Segments, OfAnEarlierRunAreRemoved) {
  const RecordedRun first = recorded(simulated(1s), 30'000, 5);
  const RecordedRun second = recorded(simulated(100ms), 10'000'000, 5);
  EXPECT_EQ(first.file, second.file);
  EXPECT_FALSE(fs::exists(segment_path(second.file, 5)));
  EXPECT_EQ(recording_in(second.file).segment, 0U);
}

TEST(Segments, ATooSmallLimitIsSaidBeforeTheRun) {
  TestSystem system;
  make_talkers(system);
  RunOptions options = simulated(1s);
  options.recording = scratch_file("run.tsr");
  options.record_limit = {1000, 3};
  std::string error;
  EXPECT_FALSE(execute(system.system(), options, error));
  EXPECT_NE(error.find("the limit of the recording is too small"), std::string::npos) << error;
}

/// `x` and `y` in turn, by two instances, and `u` of a third after `t` of the first.
[[nodiscard]] FlatNet three_in_turn() {
  FlatNet net;
  net.places = {{"a", 1}, {"b", 0}, {"c", 0}, {"d", 0}};
  net.transitions = {
      {"x", 0, {0}, {1}, ""}, {"y", 1, {1}, {0}, ""}, {"t", 0, {0}, {2}, ""}, {"u", 2, {2}, {3}, ""}};
  return net;
}

[[nodiscard]] std::unique_ptr<Recorder> recorder_of(const FlatNet& net, std::uint32_t instances,
                                                    RunOptions::Limit limit) {
  nlohmann::json header{
      {"system", "s"}, {"net_hash", ""}, {"verification_hash", ""}, {"clock", "steady"}, {"seed", 1}};
  for (std::uint32_t index = 0; index < instances; ++index)
    header["instances"].push_back(std::to_string(index));
  header["channels"] = nlohmann::json::array();
  for (const FlatNet::FlatTransition& transition : net.transitions)
    header["transitions"].push_back({transition.name, transition.instance, "other"});
  std::string error;
  auto recorder = Recorder::open(
      scratch_file("run.tsr"), {header.dump()}, instances, Recorder::Mode::threaded, error, 0, limit,
      std::make_unique<MarkingTrack>(net, std::vector<ChannelId>(net.transitions.size())));
  EXPECT_NE(recorder, nullptr) << error;
  return recorder;
}

TEST(Segments, AFiringWaitsForThoseItFollowsFromHoweverManyOthersComeMeanwhile) {
  const FlatNet net = three_in_turn();
  const auto recorder = recorder_of(net, 3, {20'000, 1000});
  recorder->lane(2)->firing(Time{}, 3, 0);  // whose thread was the first to write
  for (int turn = 0; turn < 2000; ++turn) {
    recorder->lane(0)->firing(Time{}, 0, 0);
    recorder->lane(1)->firing(Time{}, 1, 0);
  }
  recorder->lane(0)->firing(Time{}, 2, 0);
  EXPECT_EQ(recorder->close().lost, 0U);
  const Recording read_back = recording_in(scratch_file("run.tsr"));
  EXPECT_FALSE(read_back.truncated);
  ASSERT_FALSE(read_back.entries.empty());
  EXPECT_EQ(read_back.entries.back().event.subject, 3U);
  for (const Recording::Entry& entry : read_back.entries) {
    if (entry.event.kind() == Event::Kind::marking) {
      EXPECT_EQ(entry.event.version, 0U);
    }
  }
}

TEST(Segments, WhatIsLostIsSaidAtTheEndAndTheMarkingIsNotKnownThen) {
  const FlatNet net = three_in_turn();
  const auto recorder = recorder_of(net, 4000, {200'000, 1000});  // of so many, rings are short
  while (recorder->lane(0)->lost() == 0) {
    recorder->lane(0)->firing(Time{}, 0, 0);
    recorder->lane(1)->firing(Time{}, 1, 0);
  }
  const std::uint64_t lost = recorder->close().lost;
  EXPECT_GT(lost, 0U);
  const Recording read_back = recording_in(scratch_file("run.tsr"));
  EXPECT_FALSE(read_back.truncated);
  EXPECT_EQ(read_back.lost, lost);
}

TEST(Segments, AreReadWhenTheNewestIsNotThereOrNotBegun) {
  const RecordedRun limited = recorded(simulated(2s), 50'000, 4);
  const Recording all = recording_in(limited.file);
  EXPECT_FALSE(all.truncated);
  const std::string newest = file_bytes(limited.file);
  for (const bool is_there : {false, true}) {
    fs::remove(limited.file);
    if (is_there) std::ofstream(limited.file, std::ios::binary) << newest.substr(0, 100);
    const Recording left = recording_in(limited.file);
    EXPECT_TRUE(left.truncated);
    EXPECT_EQ(left.segment, all.segment);
    EXPECT_LT(left.entries.size(), all.entries.size());
    EXPECT_GT(left.entries.size(), all.entries.size() / 2);
  }
}

TEST(Segments, AreCutOffWhenTheLastOneSaysThatAnotherFollows) {
  const RecordedRun limited = recorded(simulated(2s), 50'000, 4);
  const std::uint64_t newest = *recording_in(limited.file).segment + 3;
  fs::rename(segment_path(limited.file, newest - 1), limited.file);
  EXPECT_TRUE(recording_in(limited.file).truncated);
}

TEST(Segments, FilesOfOthersAreNeitherRemovedNorWrittenOver) {
  const std::string file = scratch_file("run.tsr");
  std::ofstream(segment_path(file, 1)) << "mine";
  TestSystem system;
  make_talkers(system);
  RunOptions options = simulated(1s);
  options.recording = file;
  options.record_limit = {50'000, 3};
  std::string error;
  EXPECT_FALSE(execute(system.system(), options, error));
  EXPECT_NE(error.find("run.1.tsr' is in the way"), std::string::npos) << error;
  EXPECT_EQ(file_bytes(segment_path(file, 1)), "mine");
}

TEST(Segments, ARecordingThatHasEndedIsNoSegmentOfAnotherWhateverItsName) {
  TestSystem system;
  make_talkers(system);
  RunOptions options = simulated(100ms);
  options.recording = segment_path(scratch_file("run.tsr"), 0);
  options.record_limit = {10'000'000, 3};
  console::silence(true);
  static_cast<void>(run(system, options));
  console::silence(false);
  const std::string bytes = file_bytes(options.recording);

  TestSystem other;
  make_talkers(other);
  const std::string mine = std::exchange(options.recording, scratch_file("run.tsr"));
  std::string error;
  EXPECT_FALSE(execute(other.system(), options, error));
  EXPECT_NE(error.find("run.0.tsr' is in the way"), std::string::npos) << error;
  EXPECT_NE(error.find("--record-limit none"), std::string::npos) << error;
  EXPECT_EQ(file_bytes(mine), bytes);
}

TEST(Segments, APipeHasNoneAndStaysWhereItIs) {
  const std::string pipe = scratch_file("pipe");
  fs::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  auto reader = std::async(std::launch::async, [&] {
    std::ifstream file(pipe, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  });
  TestSystem system;
  make_talkers(system);
  RunOptions options = simulated(2s);
  options.recording = pipe;
  options.record_limit = {50'000, 3};
  console::silence(true);
  const RunSummary summary = run(system, options);
  console::silence(false);
  const std::string bytes = reader.get();
  EXPECT_EQ(summary.recorded_from, std::nullopt);
  EXPECT_EQ(fs::status(pipe).type(), fs::file_type::fifo);
  EXPECT_GT(bytes.size(), 3 * 50'000U);
  RecordingReader read;
  read.feed(bytes);
  EXPECT_TRUE(read.has_ended());
  EXPECT_FALSE(read.recording().segment);
  fs::remove(pipe);
}

TEST(Segments, EventsThatAreLostDoNotHoldUpTheOthers) {
  FlatNet net;
  net.places = {{"a", 1}, {"b", 0}};
  net.transitions = {{"t", 0, {0}, {1}, ""}, {"u", 1, {1}, {0}, ""}};
  std::string error;
  const auto recorder =
      Recorder::open(scratch_file("run.tsr"), {"{}"}, 2, Recorder::Mode::threaded, error, 0, {1'000'000, 2},
                     std::make_unique<MarkingTrack>(net, std::vector<ChannelId>(2)));
  ASSERT_NE(recorder, nullptr) << error;
  // `u` follows from a firing of `t` that is not recorded; more than half of its ring.
  for (int event = 0; event < 200'000; ++event) recorder->lane(1)->firing(Time{}, 1, 0);
  EXPECT_EQ(recorder->close().lost, 0U);
  EXPECT_GT(fs::file_size(scratch_file("run.tsr")), 200'000 * sizeof(Event) / 100);
}

}  // namespace
}  // namespace tessera::testing
