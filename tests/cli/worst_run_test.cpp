// The run in which a command is as old as it can be: proved, told, written, and made by the generated controller.
#include <string>

#include "command.hpp"

namespace tessera::cli_test {

using WorstRun = Command;

TEST_F(WorstRun, OfTheLineFollowerIsToldAndMadeByItsController) {
  const fs::path project = example("01_line_follower"), spec = project / "spec.yaml";
  replace(spec, "watch: {}", "watch: { takes: 1..2 ms }");
  replace(spec, "next: follow }", "next: follow, takes: 2..8 ms }");
  replace(spec, "follow: {}", "follow: { takes: 2..8 ms }");
  replace(spec, "drive: {}", "drive: { takes: 1..2 ms }");
  write(spec, content_of(spec) +
                  "\ntiming:\n  chains:\n    - { name: line to wheels, path: [robot.sensor, robot.control, "
                  "robot.motor], age: 82 ms, reaction: 120 ms }\n");
  const project::Exit violated = tessera("verify 01_line_follower --scenario worst.json");
  EXPECT_EQ(violated.code, 1) << violated.text;
  EXPECT_NE(violated.text.find("line to wheels: age holds (exact: 82 ms; asked 82 ms), reaction violated "
                               "(exact: 142 ms; asked 120 ms)"),
            std::string::npos)
      << violated.text;
  EXPECT_NE(violated.text.find("`tessera verify --explain \"line to wheels\"` tells a run"),
            std::string::npos)
      << violated.text;
  const project::Exit explained =
      tessera("verify 01_line_follower --explain 'line to wheels' --scenario again.json");
  EXPECT_EQ(explained.code, 1) << explained.text;
  EXPECT_EQ(content_of(folder_ / "again.json"), content_of(folder_ / "worst.json"));
  for (const char* line : {"a run with that age, from ", "a run with that reaction, from ",
                           "robot.control has received before that",
                           "robot.motor has given its command (its call took 2 ms, the longest)"})
    EXPECT_NE(explained.text.find(line), std::string::npos) << line << "\n" << explained.text;

  const project::Exit made = tessera("simulate 01_line_follower --scenario worst.json --record run.tsr");
  EXPECT_EQ(made.code, 0) << made.text;
  EXPECT_NE(made.text.find("line to wheels: reaction 142 ms, from "), std::string::npos) << made.text;
  EXPECT_NE(made.text.find(" s, as in the scenario"), std::string::npos) << made.text;
  const nlohmann::json promised = nlohmann::json::parse(content_of(folder_ / "worst.json")).at("times");
  const nlohmann::json measured =
      json("replay run.tsr --ages --spec 01_line_follower").at("ages").at(0).at("reaction");
  EXPECT_EQ(measured.at("most_ns"), 142'000'000);
  EXPECT_EQ(measured.at("worst").at("to_ns"), promised.at("to_ns"));

  // Other times make another run.
  const auto with = [&](auto change) {
    nlohmann::json other = nlohmann::json::parse(content_of(folder_ / "worst.json"));
    change(other.at("times"));
    write(folder_ / "other.json", other.dump());
    return tessera("simulate 01_line_follower --scenario other.json --record other.tsr");
  };
  const project::Exit differs = with([](nlohmann::json& times) {
    for (nlohmann::json& one : times.at("subsystems"))
      if (one.at("subsystem") == "robot.motor")
        for (nlohmann::json& call : one.at("calls")) call.at("takes_ns") = 1'000'000;
  });
  EXPECT_EQ(differs.code, 1) << differs.text;
  EXPECT_NE(differs.text.find("in the scenario"), std::string::npos) << differs.text;
  const project::Exit unknown =
      with([](nlohmann::json& times) { times.at("subsystems").at(0).at("subsystem") = "robot.sensors"; });
  EXPECT_NE(unknown.code, 0);
  EXPECT_NE(unknown.text.find("names 'robot.sensors', which is no subsystem"), std::string::npos)
      << unknown.text;
  const std::string whole = content_of(folder_ / "worst.json");
  write(folder_ / "cut.json", whole.substr(0, whole.size() / 2));
  const project::Exit cut = tessera("simulate 01_line_follower --scenario cut.json");
  EXPECT_NE(cut.code, 0);
  EXPECT_NE(cut.text.find("is no scenario"), std::string::npos) << cut.text;
}

}  // namespace tessera::cli_test
