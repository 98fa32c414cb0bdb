#include <fmt/core.h>

#include <cstdlib>

#include "../schema/judge.hpp"
#include "command.hpp"
#include "project/files/state_folder.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli_test {

using Replay = Command;

TEST_F(Replay, ARunIsALegalFiringSequenceOfTheNetOfItsSpecification) {
  const fs::path project = example("01_line_follower");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 10s").code, 0);
  schema_test::judge_summary(nlohmann::json::parse(content_of(project / ".tessera/last/summary.json")));
  const project::Exit checked = tessera("replay 01_line_follower/.tessera/last/recording.tsr --check");
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_EQ(checked.text.find("legal: "), 0U) << checked.text;
  // A project that cannot be written has its recordings elsewhere.
  setenv("TESSERA_STATE_DIR", (folder_ / "state").c_str(), 1);
  const fs::path state = project::state_folder(fs::canonical(project));
  fs::create_directories(state.parent_path());
  fs::rename(project / ".tessera", state);
  const project::Exit elsewhere = tessera("replay 01_line_follower --check");
  EXPECT_EQ(elsewhere.code, 0) << elsewhere.text;
  unsetenv("TESSERA_STATE_DIR");
  fs::rename(state, project / ".tessera");

  ASSERT_EQ(tessera("run 01_line_follower --world --for 2s --record threads.tsr --mcap live.mcap").code, 0);
  const project::Exit threads = tessera("replay threads.tsr --check --spec 01_line_follower");
  EXPECT_EQ(threads.code, 0) << threads.text;
  const project::Exit lost = tessera("replay threads.tsr --check");
  EXPECT_EQ(lost.code, 1);
  EXPECT_NE(lost.text.find("--spec"), std::string::npos) << lost.text;

  std::string bytes = content_of(folder_ / "threads.tsr");
  write(folder_ / "cut.tsr", bytes.substr(0, bytes.size() - 10));
  EXPECT_EQ(tessera("replay cut.tsr --check --spec 01_line_follower").code, 3);
  EXPECT_NE(tessera("replay cut.tsr").text.find("its end is missing"), std::string::npos);

  // As bags: written live and afterwards, they hold the same run.
  EXPECT_EQ(tessera("replay threads.tsr --spec 01_line_follower --mcap later.mcap").code, 0);
  for (const char* bag : {"live.mcap", "later.mcap"}) {
    const project::Exit legal = tessera(std::string("replay --check --spec 01_line_follower ") + bag);
    EXPECT_EQ(legal.code, 0) << bag << legal.text;
    EXPECT_EQ(tessera(std::string("replay --print ") + bag).text, tessera("replay --print threads.tsr").text);
  }
  bytes = content_of(folder_ / "live.mcap");
  write(folder_ / "cut.mcap", bytes.substr(0, bytes.size() / 2));
  EXPECT_EQ(tessera("replay cut.mcap --check --spec 01_line_follower").code, 3);
  EXPECT_EQ(tessera("rerun later.mcap 01_line_follower").code, 0);
  for (const char* file : {"a.tsr", "b.tsr"})
    EXPECT_EQ(tessera(std::string("simulate 01_line_follower --from later.mcap --record ") + file).code, 0);
  EXPECT_EQ(content_of(folder_ / "a.tsr"), content_of(folder_ / "b.tsr"));
  bytes = content_of(folder_ / "threads.tsr");

  // An unreadable recording is not illegal, alone or among several.
  write(folder_ / "header.tsr", bytes.substr(0, 40));
  for (const char* unreadable : {"missing.tsr", "01_line_follower/spec.yaml", "header.tsr"})
    for (const char* others : {"", " threads.tsr"}) {
      const project::Exit read =
          tessera(std::string("replay --check --spec 01_line_follower ") + unreadable + others);
      EXPECT_EQ(read.code, 2) << read.text;
    }

  replace(project / "spec.yaml", "init:", "start:");
  write(project / "src/control.cpp", "");
  const project::Exit other = tessera("replay threads.tsr --check --spec 01_line_follower");
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.text.find("the recording is of the net "), std::string::npos) << other.text;
}

TEST_F(Replay, ShowsWhatWasAskedFor) {
  built_example("01_line_follower");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 5s --record run.tsr").code, 0);
  const nlohmann::json summary = json("replay run.tsr");
  ASSERT_EQ(summary.at("subsystems").size(), 3U);
  for (const auto& subsystem : summary.at("subsystems")) {
    if (subsystem.at("path") == "robot.motor") continue;  // it waits for commands
    const double period = subsystem.at("path") == "robot.control" ? 0.05 : 0.02;
    EXPECT_NEAR(subsystem.at("period").at("median_s").get<double>(), period, 1e-9) << subsystem;
  }
  const project::Exit printed = tessera("replay run.tsr --print --subsystem robot.motor --from 1 --to 1.02");
  EXPECT_NE(printed.text.find("robot.motor.drive.t1"), std::string::npos) << printed.text;
  EXPECT_EQ(printed.text.find("robot.control"), std::string::npos) << printed.text;
  const project::Exit unknown = tessera("replay run.tsr --print --subsystem robot.moter");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.text.find("did you mean 'robot.motor'"), std::string::npos) << unknown.text;
  EXPECT_EQ(tessera("replay run.tsr --csv events.csv --to-perfetto trace.json").code, 0);
  const std::string csv = content_of(folder_ / "events.csv");
  EXPECT_EQ(csv.find("time_ns,sequence,kind,subsystem,version,text\n"), 0U);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')),
            summary.at("events").get<std::size_t>() + 1);
  EXPECT_TRUE(nlohmann::json::parse(content_of(folder_ / "trace.json"), nullptr, false).is_object());
  EXPECT_EQ(tessera("replay events.csv").code, 1);
}

TEST_F(Replay, ShowsValuesAndRunsTheCodeAgainOnThem) {
  const fs::path project = built_example("01_line_follower");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 5s --record run.tsr").code, 0);
  const project::Exit values = tessera("replay run.tsr --values=motion --last 1");
  EXPECT_NE(values.text.find("robot.control.motion = {linear: "), std::string::npos) << values.text;
  EXPECT_EQ(tessera("replay run.tsr --values=motion --csv motion.csv").code, 0);
  EXPECT_EQ(content_of(folder_ / "motion.csv").find("time_ns,buffer,status,stamp_ns,linear,angular\n"), 0U);
  const project::Exit nothing = tessera("replay run.tsr --values=motoin");
  EXPECT_EQ(nothing.code, 2);
  EXPECT_NE(nothing.text.find("has 'motoin' in its path; did you mean 'motion'?"), std::string::npos)
      << nothing.text;

  const nlohmann::json same = json("rerun run.tsr 01_line_follower");
  schema_test::judge_summary(same);
  EXPECT_EQ(same.at("same"), true);
  EXPECT_EQ(same.at("subsystems").at(0).at("iterations"), 100);
  ASSERT_EQ(tessera("run 01_line_follower --world --for 2s --record threads.tsr").code, 0);
  EXPECT_EQ(json("rerun threads.tsr 01_line_follower").at("same"), true);

  const project::Exit slower = tessera("rerun run.tsr 01_line_follower --set v=0.1 --json out.json");
  EXPECT_EQ(slower.code, 1) << slower.text;
  EXPECT_NE(slower.text.find("motion.linear: recorded "), std::string::npos) << slower.text;
  const nlohmann::json differs = nlohmann::json::parse(content_of(folder_ / "out.json"));
  schema_test::judge_summary(differs);
  const nlohmann::json& first = differs.at("first");
  EXPECT_EQ(first.at("subsystem"), "robot.control");
  EXPECT_EQ(first.at("what"), "motion.linear");

  ASSERT_EQ(tessera("simulate 01_line_follower --for 1s --record bare.tsr --record-values none").code, 0);
  const project::Exit none = tessera("rerun bare.tsr 01_line_follower");
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.text.find("it holds no values of buffers"), std::string::npos) << none.text;
  EXPECT_EQ(tessera("replay bare.tsr --values").code, 1);
}

/// A text of user code, which may come from a robot, or from somebody who sent the recording.
TEST_F(Replay, ATextOfARecordingDoesNotCommandTheTerminal) {
  built_example("01_line_follower");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 1s --record run.tsr").code, 0);
  std::string recording = content_of(folder_ / "run.tsr");
  const std::string ended = "duration", hidden = "\x1b[2Jgone";
  ASSERT_EQ(hidden.size(), ended.size());
  recording.replace(recording.rfind(ended), ended.size(), hidden);
  write(folder_ / "run.tsr", recording);
  for (const char* how : {"--csv -", "--print", "--to-perfetto -", "--json -", ""}) {
    const std::string line = std::string("replay run.tsr ") + how;
    const project::Exit terminal =
        shell("script -qec '" TESSERA_BINARY_DIR "/tessera " + line + "' /dev/null < /dev/null");
    EXPECT_EQ(terminal.text.find('\x1b'), std::string::npos) << how;
    const bool is_json = line.find("json") != std::string::npos || line.find("perfetto") != std::string::npos;
    EXPECT_TRUE(is_json || terminal.text.find("\\x1b[2Jgone") != std::string::npos) << how << terminal.text;
  }
  const project::Exit piped = tessera("replay run.tsr --csv -");
  EXPECT_NE(piped.text.find("stop,system,0," + hidden), std::string::npos) << "a program gets the bytes";
}

TEST_F(Replay, ReadsAndChecksTheSegmentsThatALimitLeaves) {
  built_example("01_line_follower");
  ASSERT_EQ(
      tessera("simulate 01_line_follower --for 30s --record logs/recording.tsr --record-limit 50kBx3").code,
      1)
      << "there is no such folder";
  fs::create_directories(folder_ / "logs");
  ASSERT_EQ(
      tessera("simulate 01_line_follower --for 30s --record logs/recording.tsr --record-limit 50kBx3").code,
      0);
  const project::Exit checked = tessera("replay logs --check --spec 01_line_follower");
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_EQ(checked.text.find("legal: "), 0U) << checked.text;
  const project::Exit again = tessera("rerun logs/recording.tsr 01_line_follower");
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.text.find("its beginning is gone"), std::string::npos) << again.text;
  EXPECT_EQ(tessera("simulate 01_line_follower --for 1s --record-limit 5apples").code, 2);
}

TEST_F(Replay, WhoeverReadsARecordingWithoutItsBeginningIsToldFromWhenOnItIs) {
  built_example("01_line_follower");
  const std::string limited = "simulate 01_line_follower --for 60s --record run.tsr --record-limit 50kBx3";
  const nlohmann::json summary = json(limited + " --report report");
  const double from_s = summary.at("recorded_from_s").get<double>();
  EXPECT_GT(from_s, 40);
  for (const char* of_the_whole : {"laps", "line_lost_s", "lateral_error_m"})
    EXPECT_FALSE(summary.contains(of_the_whole)) << of_the_whole;
  const std::string from = fmt::format("{:.3f} s", from_s);
  const auto expect_note = [&](const std::string& text) {
    EXPECT_NE(text.find(from), std::string::npos) << text;
    EXPECT_NE(text.find("--record-limit none"), std::string::npos) << text;
  };
  const project::Exit ran = tessera(limited);
  expect_note(ran.text);
  EXPECT_EQ(ran.text.find(" laps;"), std::string::npos) << ran.text;
  expect_note(content_of(folder_ / "report/index.html"));
  for (const char* asked : {"", "--check --spec 01_line_follower", "--print --last 1",
                            "--values=motion --last 1", "--csv out.csv", "--to-perfetto out.perfetto"}) {
    const project::Exit read = tessera(std::string("replay run.tsr ") + asked);
    EXPECT_EQ(read.code, 0) << asked;
    expect_note(read.text);
  }
  EXPECT_DOUBLE_EQ(json("replay run.tsr").at("recorded_from_s").get<double>(), from_s);
  EXPECT_EQ(tessera("rerun run.tsr 01_line_follower").code, 1);
  expect_note(tessera("rerun run.tsr 01_line_follower").text);

  // A whole recording has no such remark. A limit is there unless it was switched off.
  const nlohmann::json whole = json("simulate 01_line_follower --for 10s --record whole.tsr");
  EXPECT_FALSE(whole.contains("recorded_from_s"));
  EXPECT_TRUE(whole.contains("laps"));
  EXPECT_EQ(segment_number_in((folder_ / "whole.tsr").string()), 0U);
  ASSERT_EQ(tessera("simulate 01_line_follower --for 10s --record all.tsr --record-limit none").code, 0);
  EXPECT_EQ(segment_number_in((folder_ / "all.tsr").string()), std::nullopt);
}

}  // namespace tessera::cli_test
