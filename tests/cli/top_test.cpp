#include "command.hpp"

namespace tessera::cli_test {

using Top = Command;

TEST_F(Top, ShowsWhatEverySubsystemOfARunningControllerDoes) {
  example("01_line_follower");
  fs::create_directories(folder_ / "runtime");
  fs::permissions(folder_ / "runtime", fs::perms::owner_all);
  const std::string watch =
      "export XDG_RUNTIME_DIR=$PWD/runtime; T=" + std::string(TESSERA_BINARY_DIR) + "/tessera; ";
  ASSERT_EQ(tessera("simulate 01_line_follower --for 1s").code, 0);  // builds it
  // Until it listens, `top` says that nothing is running.
  const project::Exit done =
      shell(watch +
            "$T top; $T run 01_line_follower --world --for 60s >run.txt 2>&1 & "
            "until $T top --once --json >line.json 2>none.txt; do :; done; "
            "$T top --once; ls -l runtime/tessera; kill -INT $!; wait $!; ls runtime/tessera | wc -l");
  EXPECT_NE(done.text.find("no controller is running"), std::string::npos) << done.text;
  for (const char* part :
       {"robot.control", "of 20 Hz", "robot.sensor.line->robot.control.line", "srw-------"})
    EXPECT_NE(done.text.find(part), std::string::npos) << part << "\n" << done.text;
  EXPECT_TRUE(done.text.ends_with("0\n")) << done.text << content_of(folder_ / "run.txt");
  const nlohmann::json line = nlohmann::json::parse(content_of(folder_ / "line.json"), nullptr, false);
  ASSERT_TRUE(line.is_object());
  EXPECT_EQ(line.at("subsystems").size(), 3U);
  EXPECT_EQ(line.at("channels").size(), 2U);
}

}  // namespace tessera::cli_test
