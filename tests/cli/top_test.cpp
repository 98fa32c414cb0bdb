#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "../eventually.hpp"
#include "../schema/judge.hpp"
#include "command.hpp"
#include "project/process/control_connection.hpp"

namespace tessera::cli_test {

/// A built line follower, whose controllers have a folder of sockets of their own.
class Top : public Command {
 protected:
  void SetUp() override {
    built_example("01_line_follower");
    fs::create_directories(folder_ / "runtime");
    fs::permissions(folder_ / "runtime", fs::perms::owner_all);
    ASSERT_EQ(tessera("simulate 01_line_follower --for 1s").code, 0);
  }
  /// The beginning of scripts.
  const std::string watch_ =
      "export XDG_RUNTIME_DIR=$PWD/runtime; T=" + std::string(TESSERA_BINARY_DIR) + "/tessera; ";
};

TEST_F(Top, RunningControllersAreShownAndAllGetAnEmergencyStop) {
  // Until it listens, `top` reports that nothing is running.
  const project::Exit done =
      shell(watch_ +
            "$T top; $T run 01_line_follower --world --for 60s >run.txt 2>&1 & "
            "for i in $(seq 400); do $T top --once --json >line.json 2>none.txt && break; sleep 0.05; done; "
            "$T top --once; ls -l runtime/tessera; kill -INT $!; wait $!; ls runtime/tessera | wc -l");
  EXPECT_NE(done.text.find("no controller is running"), std::string::npos) << done.text;
  for (const char* part :
       {"robot.control", "of 20 Hz", "robot.sensor.line->robot.control.line", "srw-------"})
    EXPECT_NE(done.text.find(part), std::string::npos) << part << "\n" << done.text;
  EXPECT_EQ(done.text.find(" 0.0 of 20 Hz"), std::string::npos) << done.text;
  EXPECT_TRUE(done.text.ends_with("0\n")) << done.text << content_of(folder_ / "run.txt");
  const nlohmann::json line = nlohmann::json::parse(content_of(folder_ / "line.json"), nullptr, false);
  ASSERT_TRUE(line.is_object());
  schema_test::judge_line(line);
  EXPECT_EQ(line.at("subsystems").size(), 3U);
  EXPECT_EQ(line.at("channels").size(), 2U);

  // One of two controllers hangs: the other is stopped all the same, and the first as soon as it goes on.
  // Every wait is limited: `await` tries for 20 s.
  const project::Exit stopped = shell(
      watch_ +
      "await() { for i in $(seq 400); do if \"$@\"; then return; fi; sleep 0.05; done; echo WAITED IN VAIN: "
      "$*; }; "
      "two() { test $(ls runtime/tessera | wc -l) = 2; }; "
      "shown() { $T top $1 --once 2>>none.txt | grep -q \"$2\"; }; "
      "$T run 01_line_follower --world --for 60s >a.txt 2>&1 & "
      "$T run 01_line_follower --world --for 60s >b.txt 2>&1 & "
      "await two; set -- $(ls runtime/tessera | sed 's/[^.]*[.]//; s/[.]sock//'); "
      "await shown $1 robot; await shown $2 robot; "
      "kill -STOP $2; $T emergency-stop --why smoke; echo code $?; kill -CONT $2; "
      "await shown $1 smoke; await shown $2 smoke; "
      "$T reset; for p in $1 $2; do $T reset --controller $p; kill -INT $p; done; wait; cat a.txt b.txt");
  const auto times = [&](std::string_view what) {
    std::size_t count = 0;
    for (std::size_t at = stopped.text.find(what); at != std::string::npos;
         at = stopped.text.find(what, at + 1))
      ++count;
    return count;
  };
  EXPECT_EQ(times(": emergency stop\n"), 1U) << stopped.text;
  EXPECT_EQ(times("it is unknown whether its devices are safe"), 1U) << stopped.text;
  EXPECT_EQ(times("code 1"), 1U) << stopped.text;
  EXPECT_EQ(times("several controllers are running"), 1U) << stopped.text;
  EXPECT_EQ(times("EMERGENCY STOP: smoke"), 2U) << stopped.text;
  EXPECT_EQ(times("the emergency stop is over"), 2U) << stopped.text;
}

/// Whether all threads of a process stand still.
bool is_stopped(int process) {
  for (const auto& thread : fs::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    if (content_of(thread.path() / "stat").find(") T ") == std::string::npos) return false;
  }
  return true;
}

/// Two controllers run, and all the connections that one of them can queue are taken.
TEST_F(Top, AControllerThatTakesNoConnectionIsNamedAndTheOtherIsStopped) {
  const std::string start = "$T run 01_line_follower --world --for 120s ";
  static_cast<void>(
      shell(watch_ + start + ">a.txt 2>&1 & " + start + ">b.txt 2>&1 & " +
            "for i in $(seq 400); do test $(ls runtime/tessera | wc -l) = 2 && break; sleep 0.05; done; "
            "for p in $(ls runtime/tessera | sed 's/[^.]*[.]//; s/[.]sock//'); do "
            "for i in $(seq 400); do $T top $p --once >>seen.txt 2>&1 && break; sleep 0.05; done; done"));
  const std::vector<fs::path> sockets = project::control_sockets(folder_ / "runtime/tessera");
  ASSERT_EQ(sockets.size(), 2U) << content_of(folder_ / "a.txt");
  const auto number = [](const fs::path& socket) {
    return std::stoi(socket.stem().extension().string().substr(1));
  };
  const std::string hanging = std::to_string(number(sockets[0])), other = std::to_string(number(sockets[1]));
  kill(number(sockets[0]), SIGSTOP);
  // A thread that still runs for a moment would make room in the queue again.
  ASSERT_TRUE(eventually([&] { return is_stopped(number(sockets[0])); }));
  std::vector<project::ControlConnection> taken;
  for (;;) {
    project::ControlConnection::Attempt made = project::ControlConnection::attempt(sockets[0]);
    if (!made.connection) break;
    taken.push_back(std::move(*made.connection));
    ASSERT_LT(taken.size(), 1000U);
  }
  const std::string top = shell(watch_ + "$T top --once").text,
                    stopped = shell(watch_ + "$T emergency-stop --why smoke; echo code $?").text,
                    one = shell(watch_ + "$T emergency-stop --controller " + hanging + "; echo code $?").text;
  EXPECT_NE(top.find("line_follower." + hanging + " does not answer"), std::string::npos) << top;
  for (const std::string& text : {stopped, one}) {
    EXPECT_NE(text.find("line_follower." + hanging + " does not answer (" + sockets[0].string() +
                        "): it is unknown whether its devices are safe"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("code 1"), std::string::npos) << text;
  }
  EXPECT_NE(stopped.find("line_follower." + other + ": emergency stop"), std::string::npos) << stopped;
  for (const int signal : {SIGCONT, SIGINT})
    for (const fs::path& socket : sockets) kill(number(socket), signal);
}

}  // namespace tessera::cli_test
