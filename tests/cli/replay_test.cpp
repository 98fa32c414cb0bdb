#include "command.hpp"

namespace tessera::cli_test {

using Replay = Command;

TEST_F(Replay, ARunIsALegalFiringSequenceOfTheNetOfItsSpecification) {
  const fs::path project = example("01_line_follower");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 10s").code, 0);
  const project::Exit checked = tessera("replay 01_line_follower/.tessera/last/recording.tsr --check");
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_EQ(checked.text.find("legal: "), 0U) << checked.text;

  ASSERT_EQ(tessera("run 01_line_follower --world --for 2s --record threads.tsr").code, 0);
  const project::Exit threads = tessera("replay threads.tsr --check --spec 01_line_follower");
  EXPECT_EQ(threads.code, 0) << threads.text;
  const project::Exit lost = tessera("replay threads.tsr --check");
  EXPECT_EQ(lost.code, 1);
  EXPECT_NE(lost.text.find("--spec"), std::string::npos) << lost.text;

  std::string bytes = content_of(folder_ / "threads.tsr");
  write(folder_ / "cut.tsr", bytes.substr(0, bytes.size() - 10));
  EXPECT_EQ(tessera("replay cut.tsr --check --spec 01_line_follower").code, 3);

  replace(project / "spec.yaml", "init:", "start:");
  write(project / "src/control.cpp", "");
  const project::Exit other = tessera("replay threads.tsr --check --spec 01_line_follower");
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.text.find("the recording is of the net "), std::string::npos) << other.text;
}

TEST_F(Replay, ShowsWhatWasAskedFor) {
  example("01_line_follower");
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

}  // namespace tessera::cli_test
