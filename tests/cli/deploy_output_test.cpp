// The output of `tessera run --deploy`: without a reader, on a full disk, in a terminal that is blocked or closed.

#include <fcntl.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "deploy.hpp"

namespace tessera::cli_test {
namespace {

/// `tessera run --deploy` with its output where the test wants it.
class Started {
 public:
  Started(const fs::path& folder, const std::string& domain, int output, bool as_terminal,
          const std::string& options = "--deploy")
      : pid_(fork()) {
    if (pid_ != 0) return;
    if (as_terminal) {
      setsid();
      ioctl(output, TIOCSCTTY, 0);
      dup2(output, STDIN_FILENO);
    }
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    for (int other = 3; other < 64; ++other) close(other);
    const std::string line = "cd '" + folder.string() + "' && exec " + TESSERA_BINARY_DIR +
                             "/tessera run 11_crossing_apart " + options + " --for 120s" + domain;
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  [[nodiscard]] pid_t pid() const { return pid_; }
  /// Its exit code.
  [[nodiscard]] int wait() const {
    int status = 0;
    waitpid(pid_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t pid_;
};

TEST_F(Deploy, ItGoesOnWithoutAReaderAndOnAFullDisk) {
  const project::Exit unread = shell("bash -c '" + std::string(TESSERA_BINARY_DIR) +
                                     "/tessera run 11_crossing_apart --deploy --for 2s" + domain_ +
                                     " | head -1; echo code ${PIPESTATUS[0]}'");
  EXPECT_NE(unread.text.find("cannot write to standard output: Broken pipe; the processes go on"),
            std::string::npos)
      << unread.text;
  EXPECT_NE(unread.text.find("code 0"), std::string::npos) << unread.text;
  const project::Exit full = tessera("run 11_crossing_apart --deploy --for 2s >/dev/full" + domain_);
  EXPECT_EQ(full.code, 0) << full.text;
  EXPECT_NE(full.text.find("No space left on device; the processes go on"), std::string::npos) << full.text;
  for (const nlohmann::json& process : deployment().at("processes"))
    EXPECT_EQ(process.at("starts").back().at("ended"), "ended: duration");
}

TEST_F(Deploy, ATerminalThatTakesNothingHoldsUpNoStop) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
  fcntl(ends[1], F_SETFL, O_NONBLOCK);
  const std::string some(4096, '.');
  while (::write(ends[1], some.data(), some.size()) > 0) continue;
  fcntl(ends[1], F_SETFL, 0);
  const Started run(folder_, domain_, ends[1], /*as_terminal=*/false);
  close(ends[1]);
  ASSERT_TRUE(eventually([&] { return all_run(); }));
  kill(run.pid(), SIGINT);
  EXPECT_TRUE(eventually([&] { return !any_is_left(); })) << "it waits for the terminal";
  std::string left(4096, ' ');
  while (read(ends[0], left.data(), left.size()) > 0) continue;
  close(ends[0]);
  EXPECT_EQ(run.wait(), 128 + SIGINT);
}

TEST_F(Deploy, ATerminalThatIsClosedStopsAllSafely) {
  int terminal = -1, other_side = -1;
  ASSERT_EQ(openpty(&terminal, &other_side, nullptr, nullptr, nullptr), 0);
  const Started run(folder_, domain_, other_side, /*as_terminal=*/true);
  close(other_side);
  ASSERT_TRUE(all_fire());
  close(terminal);
  EXPECT_EQ(run.wait(), 128 + SIGHUP)
      << deployment() << content_of(project_ / ".tessera/last/process-gate.json")
      << content_of(project_ / ".tessera/last/process-rover[1].json");
  EXPECT_FALSE(any_is_left());
  for (const nlohmann::json& process : deployment().at("processes"))
    EXPECT_EQ(process.at("starts").back().at("ended"), "ended: SIGHUP") << deployment();
}

/// One process, which prints its result itself.
TEST_F(Deploy, ATerminalThatIsClosedCostsNoFileOfARun) {
  int terminal = -1, other_side = -1;
  ASSERT_EQ(openpty(&terminal, &other_side, nullptr, nullptr, nullptr), 0);
  const Started run(folder_, domain_, other_side, /*as_terminal=*/true,
                    "--process gate --json sum.json --record gate.tsr");
  close(other_side);
  EXPECT_TRUE(eventually([&] { return bytes_of_events(folder_ / "gate.tsr") > 1000; })) << "it does not fire";
  close(terminal);
  EXPECT_EQ(run.wait(), 128 + SIGHUP);
  const nlohmann::json summary = nlohmann::json::parse(content_of(folder_ / "sum.json"), nullptr, false);
  ASSERT_TRUE(summary.is_object());
  EXPECT_EQ(summary.at("ended"), "SIGHUP");
}

}  // namespace
}  // namespace tessera::cli_test
