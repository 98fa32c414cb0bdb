#include "command.hpp"

namespace tessera::cli_test {

using TeleoperationInATerminal = Command;

TEST_F(TeleoperationInATerminal, MovesTheRobotAndIsInTheRecording) {
  fs::copy(fs::path(TESSERA_SOURCE_DIR) / "studio/web/tests/e2e/projects/teleoperation", folder_ / "tele",
           fs::copy_options::recursive);
  fs::create_directories(folder_ / "runtime");
  fs::permissions(folder_ / "runtime", fs::perms::owner_all);
  const project::Exit simulated = tessera("simulate tele --for 1s");  // builds it
  EXPECT_EQ(simulated.code, 0) << simulated.text;
  EXPECT_NE(simulated.text.find("nobody operates the panels robot.console.drive, crane.cabin.lever"),
            std::string::npos)
      << simulated.text;
  // Until the controller listens, no run is found.
  const project::Exit done = shell(
      "export XDG_RUNTIME_DIR=$PWD/runtime; T=" + std::string(TESSERA_BINARY_DIR) +
      "/tessera; "
      "$T run tele --for 60s --record tele.tsr >run.txt 2>&1 & R=$!; "
      "for i in $(seq 400); do $T panel crane.cabin.lever value=-1 --for 1ms 2>>none.txt && break; sleep "
      "0.05; done; "
      "$T panel; $T panel robot.consol; $T set; "
      "$T panel robot.console.drive forward=0.5 horn=true --for 2s & "
      "sleep 1; $T panel robot.console.drive forward=0.25; echo code $?; wait $!; "
      "$T panel robot.console.drive forward=7; echo code $?; "
      "$T panel robot.console.drive forward=nan; $T panel robot.console.drive forward; "
      "$T panel robot.consol.drive forward=1; "
      "for i in $(seq 200); do $T replay tele.tsr --values=robot.console.drive 2>/dev/null | grep -q "
      "'forward: 0,' && break; sleep 0.05; done; kill -INT $R; wait");
  for (const char* part :
       {"another operator has the panel robot.console.drive", "code 1", "goes from -1 to 1, and 7 is out",
        "'nan' is neither a number nor true or false", "'forward' is not FIELD=VALUE",
        "there is no panel 'robot.consol.drive'; did you mean 'robot.console.drive'?",
        "robot.console.drive  neutral; an input counts for 0.5 s\n  forward", "there are no parameters",
        "there is no panel 'robot.consol'; did you mean 'robot.console.drive'?"})
    EXPECT_NE(done.text.find(part), std::string::npos) << part << "\n" << done.text;

  const std::string values = tessera("replay tele.tsr --values=robot.console.drive").text;
  const std::size_t none = values.find("no value");
  const std::size_t moves = values.find("{forward: 0.5, turn: 0, horn: true, light: false, gear: 0}");
  const std::size_t rests = values.find("{forward: 0, turn: 0, horn: false, light: false, gear: 0}");
  EXPECT_LT(none, moves) << values;
  EXPECT_LT(moves, rests) << values;
  EXPECT_NE(rests, std::string::npos) << values;
  EXPECT_EQ(values.find("forward: 0.25"), std::string::npos) << values;
  const project::Exit again = tessera("rerun tele.tsr tele");
  EXPECT_EQ(again.code, 0) << again.text;
  EXPECT_NE(again.text.find("as recorded"), std::string::npos) << again.text;
}

}  // namespace tessera::cli_test
