#include "project/process/process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "../scratch.hpp"

namespace tessera::project {
namespace {

namespace fs = std::filesystem;

/// A process like `tessera run`: it starts a shell with this script and ends with its exit code.
class Starter : public testing::Test {
 protected:
  Starter() : folder_(fs::temp_directory_path() / ("tessera.process." + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Starter() override {
    if (starter_ > 0) {
      kill(starter_, SIGKILL);
      waitpid(starter_, nullptr, 0);
    }
    remove_scratch(folder_);
  }

  /// Returns when the shell has touched `ready`.
  void start(
      const std::string& script, const std::function<void()>& first = [] {}) {
    fs::remove(ready());
    starter_ = fork();
    if (starter_ == 0) {
      setpgid(0, 0);  // SIGTSTP stops no process in a group without a shell
      for (const int ignored_in_background : {SIGINT, SIGQUIT}) signal(ignored_in_background, SIG_DFL);
      first();
      _exit(how_({"sh", "-c", script}));
    }
    ASSERT_TRUE(becomes([&] { return fs::exists(ready()); }));
  }
  [[nodiscard]] static bool becomes(const std::function<bool()>& condition) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > until) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  /// A shell with `echo $$ >ready`.
  [[nodiscard]] pid_t child_that_wrote_its_number() const {
    pid_t child = 0;
    static_cast<void>(becomes([&] { return static_cast<bool>(std::ifstream(ready()) >> child); }));
    return child;
  }
  /// A letter of proc(5): T is stopped.
  [[nodiscard]] static char state_of(pid_t process) {
    std::string word;
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    while (status >> word && word != "State:") continue;
    char state = 0;
    status >> state;
    return state;
  }
  [[nodiscard]] std::string ready() const { return folder_ / "ready"; }
  /// Exit code; 1000 + signal: killed by it; 2000 + signal: stopped.
  [[nodiscard]] int wait() {
    int status = 0;
    waitpid(starter_, &status, WUNTRACED);
    if (WIFSTOPPED(status)) return 2000 + WSTOPSIG(status);
    starter_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  void tell(int signal) const { kill(starter_, signal); }
  /// The starter runs the shell with this function, which returns the exit code of the starter.
  std::function<int(const Command&)> how_ = [](const Command& command) { return run(command).code; };

 private:
  fs::path folder_;
  pid_t starter_ = -1;
};

TEST_F(Starter, PassesOnEverySignalThatWouldEndIt) {
  for (const auto& [signal, name] :
       {std::pair{SIGHUP, "HUP"}, std::pair{SIGINT, "INT"}, std::pair{SIGQUIT, "QUIT"},
        std::pair{SIGTERM, "TERM"}, std::pair{SIGUSR1, "USR1"}, std::pair{SIGUSR2, "USR2"},
        std::pair{SIGALRM, "ALRM"}, std::pair{SIGXCPU, "XCPU"}, std::pair{SIGPWR, "PWR"}}) {
    SCOPED_TRACE(name);
    start("trap 'exit 42' " + std::string(name) + "; touch " + ready() + "; while :; do sleep 0.02; done");
    tell(signal);
    EXPECT_EQ(wait(), 42);
  }
}

TEST_F(Starter, OutlivesWhatOnlyTellsOfFailedWriting) {
  start("trap 'exit 42' TERM; touch " + ready() + "; while :; do sleep 0.02; done");
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGTTOU}) tell(signal);
  tell(SIGTERM);
  EXPECT_EQ(wait(), 42);
}

TEST_F(Starter, LeavesAloneWhatItWasToldToIgnore) {
  start("trap 'exit 42' TERM; touch " + ready() + "; while :; do sleep 0.02; done",
        [] { signal(SIGHUP, SIG_IGN); });
  tell(SIGHUP);
  tell(SIGTERM);
  EXPECT_EQ(wait(), 42);
}

TEST_F(Starter, StopsWithItsChildAndGoesOnWithIt) {
  start("trap 'exit 42' TERM; touch " + ready() + "; while :; do sleep 0.02; done");
  tell(SIGTSTP);
  ASSERT_EQ(wait(), 2000 + SIGSTOP);
  tell(SIGCONT);
  tell(SIGTERM);
  EXPECT_EQ(wait(), 42);
}

TEST_F(Starter, StopsWithAChildThatWritesNothingWhileItReadsItsOutput) {
  how_ = [](const Command& command) { return capture(command).code; };
  start("trap 'exit 42' TERM; touch " + ready() + "; while :; do sleep 0.02; done");
  tell(SIGTSTP);
  ASSERT_EQ(wait(), 2000 + SIGSTOP);
  tell(SIGCONT);
  tell(SIGTERM);
  EXPECT_EQ(wait(), 42);
}

/// A shell starts programs with vfork(): it cannot stop while the program that it starts is stopped already.
TEST_F(Starter, StopsWithAChildThatCannotStop) {
  how_ = [](const Command& command) { return capture(command).code; };
  start("trap 'exit 42' TERM; trap '' TSTP; touch " + ready() + "; while :; do sleep 0.02; done");
  tell(SIGTSTP);
  ASSERT_EQ(wait(), 2000 + SIGSTOP);
  tell(SIGCONT);
  tell(SIGTERM);
  EXPECT_EQ(wait(), 42);
}

/// cmake starts ninja, which starts the compiler; each of them has the output open.
TEST_F(Starter, EndsAllThatACapturedProgramHasStartedAndSaysWhichSignalItWas) {
  how_ = [](const Command& command) { return capture(command).signal; };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    start("sh -c 'touch " + ready() + "; sleep 1000; true'; true");
    tell(signal);
    EXPECT_EQ(wait(), signal);
  }
}

TEST_F(Starter, IsNotHeldByOutputThatNobodyReadsOnceItWasAskedToStop) {
  // The shell may be slow to start `sleep`, but its trap is set when it is ready.
  const std::string script = "trap 'exit 42' TERM; touch " + ready() + "; while :; do sleep 0.02; done";
  for (const bool captured : {false, true}) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    ASSERT_NE(fcntl(ends[1], F_SETFL, O_NONBLOCK), -1);
    const std::string some(4096, '.');
    while (write(ends[1], some.data(), some.size()) > 0) continue;
    ASSERT_NE(fcntl(ends[1], F_SETFL, 0), -1);
    how_ = [&](const Command& command) {
      const int code = captured ? capture(command).code : run(command).code;
      for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        if (write(stream, "the end\n", 8) != 8) return 1;
      return code;
    };
    start(script, [&] {
      for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) dup2(ends[1], stream);
    });
    tell(SIGTERM);
    EXPECT_EQ(wait(), 42);
    close(ends[0]);
    close(ends[1]);
  }
}

TEST_F(Starter, EndsAChildThatIsStopped) {
  start("trap 'exit 42' TERM; echo $$ >" + ready() + "; kill -STOP $$; while :; do sleep 0.02; done");
  const pid_t child = child_that_wrote_its_number();
  ASSERT_TRUE(becomes([&] { return state_of(child) == 'T'; }));
  tell(SIGTERM);
  EXPECT_EQ(wait(), 42);
}

TEST_F(Starter, WaitsForAChildThatSomebodyElseStopsAndContinues) {
  start("trap 'exit 42' TERM; echo $$ >" + ready() + "; while :; do sleep 0.02; done");
  const pid_t child = child_that_wrote_its_number();
  ASSERT_GT(child, 0);
  kill(child, SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // time for the mistake to happen
  kill(child, SIGCONT);
  kill(child, SIGTERM);
  EXPECT_EQ(wait(), 42);
}

}  // namespace
}  // namespace tessera::project
