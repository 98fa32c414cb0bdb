#include <fmt/core.h>
#include <unistd.h>

#include "../environment.hpp"
#include "../schema/judge.hpp"
#include "command.hpp"

namespace tessera::cli_test {

using Simulate = Command;

TEST_F(Simulate, SameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  const fs::path project = built_example("01_line_follower");
  const auto run = [&](const std::string& seed, const std::string& name) {
    EXPECT_EQ(tessera("simulate 01_line_follower --for 10s --seed " + seed + " --record " + name).code, 0);
    EXPECT_FALSE(fs::exists(project / ".tessera/last/path.csv"));
    return content_of(folder_ / name);
  };
  const std::string first = run("1", "first.tsr");
  EXPECT_GT(first.size(), 100'000U);
  EXPECT_EQ(first, run("1", "second.tsr"));
  EXPECT_NE(first, run("2", "third.tsr"));
}

TEST_F(Simulate, TheRobotKeepsToEveryShippedTrack) {
  built_example("01_line_follower");
  struct Case {
    const char* options;
    double laps;
  };
  for (const Case& track : {Case{"", 3}, Case{"--track curves.png", 1}}) {
    for (std::uint64_t seed = 1; seed <= share_of(2); ++seed) {
      const nlohmann::json run =
          json(fmt::format("simulate 01_line_follower --for 120s --seed {} {}", seed, track.options));
      EXPECT_GE(run.at("laps"), track.laps) << track.options;
      EXPECT_LE(run.at("longest_loss_s"), 1) << track.options;
    }
  }
}

TEST_F(Simulate, TheSecondExampleCrossesGaps) {
  example("02_gap");
  const nlohmann::json run = json("simulate 02_gap --for 120s");
  EXPECT_GE(run.at("laps"), 1);
}

TEST_F(Simulate, ParametersChangeTheRunWithoutCompiling) {
  const fs::path project = example("01_line_follower");
  const double normal = json("simulate 01_line_follower --for 10s").at("laps");
  const auto built = fs::last_write_time(project / ".tessera/build/release/controller");
  EXPECT_LT(json("simulate 01_line_follower --for 10s --set v=0.05").at("laps"), normal * 0.6);
  write(project / "params.yaml", "v: 0.05\n");
  EXPECT_LT(json("simulate 01_line_follower --for 10s").at("laps"), normal * 0.6);
  EXPECT_EQ(fs::last_write_time(project / ".tessera/build/release/controller"), built);
}

TEST_F(Simulate, WrongParametersAndTracksAreNamedBeforeAnythingIsBuilt) {
  const fs::path project = example("01_line_follower");
  const project::Exit unknown = tessera("simulate 01_line_follower --for 1s --set vv=1");
  EXPECT_EQ(unknown.code, 1) << unknown.text;
  EXPECT_NE(unknown.text.find("did you mean"), std::string::npos) << unknown.text;
  EXPECT_EQ(tessera("simulate 01_line_follower --for 1s --set v=fast").code, 1);
  const project::Exit nowhere = tessera("simulate 01_line_follower --for 1s --track nowhere.png");
  EXPECT_EQ(nowhere.code, 1);
  EXPECT_NE(nowhere.text.find("nowhere.png"), std::string::npos) << nowhere.text;
  EXPECT_EQ(tessera("simulate 01_line_follower --for soon").code, 2);
  replace(project / "spec.yaml", "world: line_world.xml", "world: line_wrold.xml");
  const project::Exit no_world = tessera("simulate 01_line_follower --for 1s");
  EXPECT_EQ(no_world.code, 1);
  EXPECT_NE(no_world.text.find("error E310: there is no world 'line_wrold.xml'"), std::string::npos)
      << no_world.text;
  EXPECT_FALSE(fs::exists(project / ".tessera/build"));
}

TEST_F(Simulate, SchedulesFindTheSeedThatBreaksAnAssertionAndSayHowToMakeItAgain) {
  const fs::path project = example("01_line_follower");
  const nlohmann::json good = json("schedules 20 01_line_follower");
  EXPECT_EQ(good.at("tried"), 20);
  EXPECT_EQ(good.at("simulated_s"), 20.0);
  EXPECT_TRUE(good.at("failure").is_null());

  // In parts on several machines, and joined.
  for (const char* part : {"1", "2", "3"})
    tessera(fmt::format("schedules 20 01_line_follower --part {}/3 --json {}.json --coverage", part, part));
  const project::Exit two = tessera("merge 1.json 3.json --json 13.json");
  EXPECT_EQ(two.code, 3) << two.text;
  EXPECT_NE(two.text.find("missing: part 2/3: seeds 7 to 13"), std::string::npos) << two.text;
  tessera("merge 2.json 13.json --json all.json");
  const nlohmann::json joined = nlohmann::json::parse(content_of(folder_ / "all.json"));
  for (const char* same : {"net", "controller", "settings", "ran", "tried", "firings", "kinds"})
    EXPECT_EQ(joined.at(same), good.at(same)) << same;
  const project::Exit twice = tessera("merge 13.json 1.json");
  EXPECT_EQ(twice.code, 1);
  EXPECT_NE(twice.text.find("both have seeds 1 to 6"), std::string::npos) << twice.text;

  // The coverage of the runs is the same by counting and by recordings.
  const auto reached = [&](const std::string& arguments) {
    const project::Exit done =
        tessera("replay --spec 01_line_follower " + arguments + " --coverage=coverage.json");
    EXPECT_EQ(done.code, 0) << done.text;
    return nlohmann::json::parse(content_of(folder_ / "coverage.json"), nullptr, false);
  };
  tessera("simulate 01_line_follower --for 1s --interleave --seed 1 --record one.tsr");
  tessera("schedules 1 01_line_follower --json one.json --coverage");
  EXPECT_EQ(reached("one.tsr"), reached("one.json"));
  const nlohmann::json both = reached("all.json one.tsr");
  EXPECT_EQ(both.at("runs"), 21);
  EXPECT_EQ(both.at("behaviours").at("reached"), 4);
  EXPECT_LT(both.at("conditions").at("reached"), both.at("conditions").at("all"));

  // Whether a reading has come by the end of the first instant is up to the order in it.
  replace(project / "src/control.cpp", "  out.motion = steer(",
          "  context.assert_that(in.line.valid, \"blind in iteration {}\", context.iteration);\n"
          "  out.motion = steer(");
  const std::uint64_t tried = share_of(1000);
  const project::Exit found = tessera(fmt::format("schedules {} 01_line_follower --json out.json", tried));
  EXPECT_EQ(found.code, 1) << found.text;
  const nlohmann::json failure = nlohmann::json::parse(content_of(folder_ / "out.json"));
  EXPECT_NE(found.text.find("robot.control.follow.in: blind in iteration 1"), std::string::npos)
      << found.text;
  EXPECT_EQ(failure.at("tried"), tried);
  EXPECT_GT(failure.at("failed"), 0);
  EXPECT_EQ(failure.at("not_repeated"), nlohmann::json::array());
  EXPECT_EQ(failure.at("outcomes").at(0).at("kind"), "assertion");
  EXPECT_EQ(failure.at("outcomes").at(0).at("name"), "robot.control");
  EXPECT_NE(tessera("merge all.json out.json").text.find("the programs"), std::string::npos);
  std::string again = failure.at("reproduce");
  ASSERT_TRUE(again.starts_with("tessera simulate ")) << again;
  const project::Exit made = tessera(again.substr(8));
  EXPECT_EQ(made.code, 1) << made.text;
  EXPECT_NE(made.text.find("blind in iteration 1"), std::string::npos) << made.text;
  const project::Exit printed =
      tessera("replay 01_line_follower/.tessera/last/recording.tsr --print --last 12");
  EXPECT_NE(printed.text.find("fault (assertion): robot.control.follow.in: blind in iteration 1"),
            std::string::npos)
      << printed.text;

  std::size_t summaries = 0;
  for (const auto& entry : fs::recursive_directory_iterator(project / ".tessera/runs"))
    if (entry.path().filename() == "summary.json") {
      schema_test::judge_summary(nlohmann::json::parse(content_of(entry.path())));
      ++summaries;
    }
  EXPECT_GT(summaries, 5U);
}

TEST_F(Simulate, PlantedFaultsAreRecordedAndWrongOnesExplained) {
  built_example("01_line_follower");
  const project::Exit thrown =
      tessera("simulate 01_line_follower --for 5s --inject robot.control.follow:throw@2.5s");
  EXPECT_EQ(thrown.code, 1) << thrown.text;
  const project::Exit printed =
      tessera("replay 01_line_follower/.tessera/last/recording.tsr --print --from 2.4");
  for (const char* line : {"robot.control: injected: robot.control.follow:throw@2.5s",
                           "robot.control: fault (exception): robot.control.follow.in: injected",
                           "ended by an error that no `next` leads to another behaviour"})
    EXPECT_NE(printed.text.find(line), std::string::npos) << printed.text;
  const project::Exit summary = tessera("replay 01_line_follower/.tessera/last/recording.tsr");
  EXPECT_NE(summary.text.find("1 errors, 2 faults"), std::string::npos) << summary.text;
  const project::Exit checked = tessera("replay 01_line_follower/.tessera/last/recording.tsr --check");
  EXPECT_NE(checked.text.find("legal: "), std::string::npos) << checked.text;

  // NaN inside a structure.
  tessera("simulate 01_line_follower --for 5s --inject robot.control:nan@1s");
  EXPECT_NE(tessera("replay 01_line_follower/.tessera/last/recording.tsr --print --containing finite")
                .text.find("robot.control.follow.in: output 'motion' is not finite"),
            std::string::npos);

  const project::Exit wrong =
      tessera("simulate 01_line_follower --for 1s --inject robot.control.folow:throw@1s");
  EXPECT_EQ(wrong.code, 1) << wrong.text;
  EXPECT_NE(wrong.text.find("unknown 'robot.control.folow'; did you mean 'robot.control.follow'?"),
            std::string::npos)
      << wrong.text;
}

TEST_F(Simulate, RunWithoutDriversNamesTheRealBuffer) {
  built_example("01_line_follower");
  const project::Exit done = tessera("run 01_line_follower --for 1s");
  EXPECT_EQ(done.code, 1);
  EXPECT_NE(done.text.find("robot.sensor.left"), std::string::npos) << done.text;
}

TEST_F(Simulate, RunInTheWorldTakesRealTime) {
  built_example("01_line_follower");
  const nlohmann::json run = json("run 01_line_follower --world --for 2s");
  EXPECT_GE(run.at("wall_s"), 1.9);
  EXPECT_GT(run.at("firings"), 500);
}

TEST_F(Simulate, InterruptEndsARunSafelyWithItsOwnExitCode) {
  built_example("01_line_follower");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 1s").code, 0);
  // The signal comes when the run is on, however long it takes to begin. A shell lets programs that run
  // beside it ignore SIGINT.
  const project::Exit done =
      shell("{ env --default-signal=INT " TESSERA_BINARY_DIR
            "/tessera run 01_line_follower --world --for 600s >told 2>&1 & } ; "
            "until ls 01_line_follower/.tessera/runs/*-run-*/recording.tsr >/dev/null 2>&1 || ! kill -0 $!; "
            "do sleep 0.1; done; sleep 1; kill -INT $!; wait $!; code=$?; cat told; exit $code");
  EXPECT_EQ(done.code, 130) << done.text;
  EXPECT_NE(done.text.find("SIGINT"), std::string::npos) << done.text;
}

}  // namespace tessera::cli_test
