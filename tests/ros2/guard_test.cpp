// `tessera guard` between programs of another implementation of DDS, which are killed.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "fast_peer.hpp"

extern char** environ;

namespace tessera::ros2 {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// A program that is killed at the end of its life.
class Program {
 public:
  Program(std::vector<std::string> words, const fs::path& log) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    EXPECT_EQ(posix_spawn(&process_, arguments[0], &actions, nullptr, arguments.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Program() { end(SIGKILL); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  [[nodiscard]] bool has_ended() { return process_ <= 0 || waitpid(process_, &status_, WNOHANG) == process_; }
  int end(int signal) {
    if (process_ <= 0) return status_;
    kill(process_, signal);
    waitpid(process_, &status_, 0);
    process_ = 0;
    return status_;
  }

 private:
  pid_t process_ = 0;
  int status_ = 0;
};

/// The base, which takes the commands of the guard.
class Base {
 public:
  explicit Base(const std::string& domain)
      : peer_(static_cast<std::uint32_t>(std::stoi(domain))),
        reader_(peer_.reader<fast::Twist>("rt/cmd_vel")) {}

  /// Whether the base is told to drive that fast; it waits as long as the guard lives, at most two minutes.
  [[nodiscard]] bool is_told(double linear_x, Program& guard) {
    const Clock::time_point until = Clock::now() + std::chrono::minutes(2);
    last_ = -1;
    while (Clock::now() < until && !guard.has_ended()) {
      static_cast<void>(drove());
      if (last_ == linear_x) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  /// Whether the base stands that long without a break, within two minutes. On a loaded machine a command that was on
  /// its way may come after the first zero.
  [[nodiscard]] bool stands(std::chrono::milliseconds time, Program& guard) {
    const Clock::time_point until = Clock::now() + std::chrono::minutes(2);
    Clock::time_point since = Clock::now();
    while (Clock::now() < until && !guard.has_ended()) {
      if (drove()) since = Clock::now();
      if (Clock::now() - since >= time) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  [[nodiscard]] double fastest() const { return fastest_; }

 private:
  /// Takes the commands that have come. Whether one of them was to drive.
  bool drove() {
    bool found = false;
    while (const auto twist = fast::Peer::take<fast::Twist>(*reader_)) {
      last_ = std::abs(twist->linear_x);
      fastest_ = std::max(fastest_, last_);
      found = found || last_ != 0;
    }
    return found;
  }

  fast::Peer peer_;
  eprosima::fastdds::dds::DataReader* reader_;
  double last_ = -1, fastest_ = 0;
};

// TESSERA_GUARD_KILLS=100 measures: the times from the death of the publisher to the zero command are printed.
TEST(Guard, StopsABaseWhosePublisherDiesIsTooFastOrNotAlone) {
  const std::string domain = std::to_string(60 + getpid() % 50);
  const fs::path folder = fs::path(testing::TempDir()) / ("ros2_guard_" + std::to_string(getpid()));
  fs::create_directories(folder);
  setenv("ROS_DOMAIN_ID", domain.c_str(), 1);
  setenv("TESSERA_STATE_DIR", folder.c_str(), 1);
  const fs::path log = folder / "log";
  const auto text = [&] {
    std::ifstream stream(log);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  Base base(domain);
  Program guard({TESSERA_BINARY_DIR "/tessera", "guard", "/cmd_vel_in", "/cmd_vel", "--max", "0.5,1.0"}, log);
  const auto publisher = [&](const char* linear_x) {
    return Program({TESSERA_ROS2_VELOCITIES, domain, "/cmd_vel_in", linear_x}, folder / "publisher");
  };

  const char* const asked = std::getenv("TESSERA_GUARD_KILLS");
  std::vector<double> times_ms;
  for (int kills = asked == nullptr ? 2 : std::atoi(asked); kills > 0; --kills) {
    Program one = publisher("0.25");
    ASSERT_TRUE(base.is_told(0.25, guard)) << text();
    const Clock::time_point death = Clock::now();
    one.end(SIGKILL);
    ASSERT_TRUE(base.is_told(0, guard)) << text();
    times_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - death).count());
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // the killed one counts for a second
  }
  std::ranges::sort(times_ms);
  if (asked != nullptr)
    std::printf("from death to zero: median %.1f ms, longest %.1f ms, %td of %zu within 250 ms\n",
                times_ms[times_ms.size() / 2], times_ms.back(),
                std::ranges::upper_bound(times_ms, 250.0) - times_ms.begin(), times_ms.size());

  Program good = publisher("0.25");
  ASSERT_TRUE(base.is_told(0.25, guard)) << text();
  {
    Program second = publisher("0.125");
    const Clock::time_point until = Clock::now() + std::chrono::minutes(2);
    while (text().find("programs publish") == std::string::npos && Clock::now() < until)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_TRUE(base.stands(std::chrono::milliseconds(500), guard)) << "two programs publish\n" << text();
  }
  ASSERT_TRUE(base.is_told(0.25, guard)) << "the second one is gone\n" << text();
  good.end(SIGKILL);
  ASSERT_TRUE(base.stands(std::chrono::milliseconds(1100), guard)) << text();
  Program fast = publisher("0.75");
  const Clock::time_point until = Clock::now() + std::chrono::minutes(2);
  while (text().find("the command is too fast") == std::string::npos && Clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(base.stands(std::chrono::milliseconds(1000), guard)) << "too fast\n" << text();
  EXPECT_EQ(base.fastest(), 0.25) << "the command that was too fast";
  guard.end(SIGINT);
  EXPECT_NE(text().find("the command is too fast"), std::string::npos) << text();
  fs::remove_all(folder);
}

}  // namespace
}  // namespace tessera::ros2
