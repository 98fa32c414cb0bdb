#include "system/service.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "../eventually.hpp"
#include "nets.hpp"
#include "system/console.hpp"
#include "test_system.hpp"

namespace tessera::testing {
namespace {

using namespace std::chrono_literals;

/// In the place of the service manager.
class Manager {
 public:
  enum class Address : std::uint8_t { path, abstract };
  explicit Manager(Address address = Address::abstract)
      : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const std::string number = std::to_string(getpid());
    name_ = address == Address::path
                ? (std::filesystem::temp_directory_path() / ("tessera_notify_" + number)).string()
                : "@tessera_notify_" + number;
    sockaddr_un there{};
    there.sun_family = AF_UNIX;
    std::copy(name_.begin(), name_.end(), there.sun_path);
    if (name_[0] == '@')
      there.sun_path[0] = '\0';
    else
      unlink(name_.c_str());
    const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size());
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&there), bytes), 0);
    setenv("NOTIFY_SOCKET", name_.c_str(), 1);
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;
  ~Manager() {
    for (const char* const variable : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) unsetenv(variable);
    close(socket_);
    if (name_[0] != '@') unlink(name_.c_str());
  }

  /// The next message; empty: there is none.
  [[nodiscard]] std::string next() const {
    std::array<char, 512> text{};
    const ssize_t count = recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
  }
  [[nodiscard]] std::vector<std::string> all() const {
    std::vector<std::string> messages;
    for (std::string message = next(); !message.empty(); message = next()) messages.push_back(message);
    return messages;
  }

 private:
  int socket_;
  std::string name_;
};

TEST(Service, IsToldWhatTheRunDoes) {
  for (const auto address : {Manager::Address::path, Manager::Address::abstract}) {
    const Manager there(address);
    ServiceManager manager;
    manager.ready();
    EXPECT_EQ(there.next(), "READY=1");
    manager.status("3 subsystems run");
    EXPECT_EQ(there.next(), "STATUS=3 subsystems run");
    manager.stopping();
    EXPECT_EQ(there.next(), "STOPPING=1");
    EXPECT_EQ(manager.beat(Time{}), Time::max());  // no manager asked for it
    EXPECT_EQ(there.next(), "");
    EXPECT_EQ(std::getenv("NOTIFY_SOCKET"), nullptr);
  }
}

TEST(Service, GetsASignOfLifeInTimeForItsWatchdog) {
  const Manager there;
  setenv("WATCHDOG_USEC", "300000", 1);
  setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
  ServiceManager manager;
  EXPECT_EQ(manager.beat(Time{}), Time(100ms));
  EXPECT_EQ(there.next(), "WATCHDOG=1");
  EXPECT_EQ(manager.beat(Time(99ms)), Time(100ms));
  EXPECT_EQ(there.next(), "");
  EXPECT_EQ(manager.beat(Time(120ms)), Time(220ms));
  EXPECT_EQ(there.next(), "WATCHDOG=1");
}

TEST(Service, IgnoresAWatchdogOfAnotherProcessAndNonsense) {
  const Manager there;
  setenv("WATCHDOG_USEC", "300000", 1);
  setenv("WATCHDOG_PID", "1", 1);
  EXPECT_EQ(ServiceManager().beat(Time{}), Time::max());
  for (const char* const limit : {"", "soon", "-5", "0", "99999999999999999999"}) {
    setenv("NOTIFY_SOCKET", "@tessera_nobody", 1);
    setenv("WATCHDOG_USEC", limit, 1);
    EXPECT_EQ(ServiceManager().beat(Time{}), Time::max()) << limit;
  }
  for (const char* const name : {"", "/", "@", "relative", "vsock:2:1"}) {
    setenv("NOTIFY_SOCKET", name, 1);
    ServiceManager().ready();  // without a manager
  }
  setenv("NOTIFY_SOCKET", ("/" + std::string(200, 'x')).c_str(), 1);
  ServiceManager().ready();
  EXPECT_EQ(there.next(), "");
}

TEST(Service, GetsNoSignOfLifeWhileASubsystemStalls) {
  const Manager there;
  setenv("WATCHDOG_USEC", "30000", 1);
  TestSystem system;
  Script stalls, other;
  std::vector<std::string> before, meanwhile;
  std::atomic<int> others_iterations{0};
  other.call = [&](ScriptState&) { ++others_iterations; };
  stalls.call = [&](ScriptState& state) {
    if (state.context.iteration < 20) return;
    // Beats until the alarm is raised, and then none, however long the other subsystem goes on.
    EXPECT_TRUE(eventually([&] {
      const std::vector<std::string> more = there.all();
      before.insert(before.end(), more.begin(), more.end());
      return std::any_of(before.begin(), before.end(), [](const std::string& message) {
        return message.find("stalls") != std::string::npos;
      });
    }));
    const int many_beats = 40, begin = others_iterations;
    EXPECT_TRUE(eventually([&] { return others_iterations > begin + many_beats; }));
    meanwhile = there.all();
    state.context.stop("enough");
  };
  system.add("robot.control", nets::alone, stalls, 5ms, 0ms, Kind::control, Policies{.watchdog = 20ms});
  system.add("robot.other", nets::alone, other, 5ms, 0ms, Kind::control);
  console::silence(true);
  static_cast<void>(run(system, steady(60s)));
  console::silence(false);
  ASSERT_FALSE(before.empty());
  EXPECT_EQ(before.front(), "READY=1");
  EXPECT_NE(std::find(before.begin(), before.end(), "WATCHDOG=1"), before.end());
  EXPECT_EQ(std::find(meanwhile.begin(), meanwhile.end(), "WATCHDOG=1"), meanwhile.end());
  const std::vector<std::string> after = there.all();
  EXPECT_NE(std::find(after.begin(), after.end(), "STOPPING=1"), after.end());
}

TEST(Service, WritesLinesWithTheirLevelIfStandardErrorIsTheJournal) {
  const std::string file = scratch_file("journal");
  const int before = dup(STDERR_FILENO), target = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  dup2(target, STDERR_FILENO);
  struct stat status {};
  fstat(STDERR_FILENO, &status);
  for (const bool journal : {true, false}) {
    const std::string inode = std::to_string(status.st_ino + (journal ? 0 : 1));
    setenv("JOURNAL_STREAM", (std::to_string(status.st_dev) + ":" + inode).c_str(), 1);
    const console::Session session;
    console::progress("half way");
    console::print(LogLevel::error, Time(1s), "robot.control", journal ? "to the journal" : "elsewhere");
    console::print(LogLevel::warning, Time(1s), "robot.control", "careful");
    console::print(LogLevel::info, Time(1s), "robot.control", "all is well");
  }
  unsetenv("JOURNAL_STREAM");
  dup2(before, STDERR_FILENO);
  close(before);
  close(target);
  const std::string text = file_bytes(file);
  EXPECT_TRUE(
      text.starts_with("<3>1.000 s  robot.control  error: to the journal\n"
                       "<4>1.000 s  robot.control  warning: careful\n"
                       "<6>1.000 s  robot.control  all is well\n"))
      << text;
  EXPECT_EQ(text.find("<3>", 1), std::string::npos) << text;
  EXPECT_NE(text.find("half way"), std::string::npos) << text;
}

}  // namespace
}  // namespace tessera::testing
