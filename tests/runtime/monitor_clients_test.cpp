#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../eventually.hpp"
#include "controlled_run.hpp"
#include "nets.hpp"
#include "tessera/monitor.hpp"
#include "test_system.hpp"
#include "watch/monitor_socket.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using nlohmann::json;

TEST(MonitorSocket, ListensWhateverTheLengthOfTheNameOrOfTheFolder) {
  const std::string before = std::getenv("XDG_RUNTIME_DIR") == nullptr ? "" : std::getenv("XDG_RUNTIME_DIR");
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("m" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
  const std::string robot = "warehouse_of_the_north.", cart = std::string(90, 'c') + "art";
  EXPECT_EQ(monitor_file("robot", 47), folder / "tessera/robot.47.sock");
  EXPECT_FALSE(has_shortened_name(monitor_file("robot", 47)));
  EXPECT_TRUE(has_shortened_name(monitor_file(robot + cart, 47)));
  EXPECT_NE(monitor_file(robot + cart, 47), monitor_file(robot + cart + "b", 47));
  EXPECT_NE(monitor_file(robot + cart, 47).find("/warehouse_of_the_north."), std::string::npos);
  for (const std::string& name : {std::string("robot"), robot + cart}) {
    const MonitorSocket socket(name);
    EXPECT_GE(socket.descriptor(), 0) << socket.failure().value_or(Problem{}).text;
    EXPECT_TRUE(std::filesystem::exists(monitor_file(name, getpid())));
  }
  setenv("XDG_RUNTIME_DIR", (folder / std::string(100, 'f')).c_str(), 1);
  EXPECT_EQ(monitor_folder(), "/tmp/tessera-" + std::to_string(geteuid()));
  if (before.empty())
    unsetenv("XDG_RUNTIME_DIR");
  else
    setenv("XDG_RUNTIME_DIR", before.c_str(), 1);
  std::filesystem::remove_all(folder);
}

/// Sockets of another user would answer what that user likes, so nothing listens there, and the reason is told.
TEST(MonitorSocket, AFolderThatIsNotOfThisUserAloneIsNamed) {
  namespace fs = std::filesystem;
  const std::string before = std::getenv("XDG_RUNTIME_DIR") == nullptr ? "" : std::getenv("XDG_RUNTIME_DIR");
  const fs::path above = fs::temp_directory_path() / ("n" + std::to_string(getpid()));
  const fs::path folder = above / "tessera";
  fs::create_directories(above / "other");
  setenv("XDG_RUNTIME_DIR", above.c_str(), 1);
  EXPECT_FALSE(wrong_with_monitor_folder()) << "it can be made";
  struct Wrong {
    std::function<void()> make;
    std::string what;
  };
  std::vector<Wrong> all{
      {[&] { fs::create_directory(folder), fs::permissions(folder, fs::perms(0755)); },
       "may be entered by other users: remove it, or set XDG_RUNTIME_DIR to a folder of your own"},
      {[&] { fs::permissions(above / "other", fs::perms(0700)), fs::create_symlink("other", folder); },
       "is a link"},
      {[&] { std::ofstream(folder) << "text"; }, "is no folder"},
      {[&] { setenv("XDG_RUNTIME_DIR", (above / "nowhere").c_str(), 1); }, "No such file or directory"}};
  if (geteuid() == 0)
    all.insert(all.begin(), {[&] { fs::create_directory(folder), lchown(folder.c_str(), 1, 1); },
                             "belongs to another user (number 1)"});
  for (const Wrong& wrong : all) {
    wrong.make();
    const std::optional<Problem> told = wrong_with_monitor_folder();
    ASSERT_TRUE(told) << wrong.what;
    EXPECT_NE(told->text.find(wrong.what), std::string::npos) << told->text;
    const MonitorSocket socket("robot");
    EXPECT_LT(socket.descriptor(), 0) << wrong.what;
    ASSERT_TRUE(socket.failure());
    EXPECT_NE(socket.failure()->text.find(wrong.what), std::string::npos) << socket.failure()->text;
    TestSystem system;
    system.add("robot.a", nets::alone, {}, 1ms);
    RunOptions options = steady(1min);
    options.monitor = true;
    std::string error;
    EXPECT_FALSE(execute(system.system(), options, error)) << wrong.what;
    EXPECT_TRUE(
        error.starts_with("the run could not be stopped from outside, since it has no control socket: "))
        << error;
    fs::remove_all(folder);
  }
  if (before.empty())
    unsetenv("XDG_RUNTIME_DIR");
  else
    setenv("XDG_RUNTIME_DIR", before.c_str(), 1);
  fs::remove_all(above);
}

TEST_F(Controlled, TheRecordingComesThroughTheSocketAsFarAsTheRunHasCome) {
  start();
  rest(1);
  std::string recorded;
  for (std::uint64_t step = 2; step < 10; ++step) {
    do recorded += piece();
    while (more_);
    EXPECT_EQ(recorded, file_bytes(options_.recording));
    EXPECT_EQ(command({{"command", "step_firing"}}), "");
    rest(step);
  }
  finish();
  recorded += what_comes_at_the_end();
  EXPECT_EQ(recorded, file_bytes(options_.recording));
}

TEST_F(Controlled, InRealTimeTheRecordingCanBeHadAndNothingElse) {
  options_.clock = RunOptions::Clock::steady;
  options_.duration = 600s;
  start();
  std::string recorded;
  while (recorded.size() < 10'000 || more_) recorded += piece();
  EXPECT_EQ(file_bytes(options_.recording).substr(0, recorded.size()), recorded);
  EXPECT_NE(command({{"command", "pause"}}), "");
  kill(getpid(), SIGTERM);
  running_.join();
  EXPECT_EQ(summary_.ended, "SIGTERM");
  recorded += what_comes_at_the_end();
  EXPECT_EQ(recorded, file_bytes(options_.recording));
}

TEST_F(Controlled, WithoutARecordingThereAreNoBytes) {
  options_.recording.clear();
  start();
  rest(1);
  EXPECT_EQ(piece(), "");
  EXPECT_FALSE(more_);
  finish();
}

TEST_F(Controlled, EndsWithItsOwner) {
  start();
  rest(1);
  send_line("{\"command\":\"own\"}");
  EXPECT_EQ(command({{"command", "pause"}}), "");
  close(socket_);
  socket_ = -1;
  running_.join();
  EXPECT_EQ(summary_.ended, "stopped: the process that started it has ended");
}

TEST_F(Controlled, ExecutesCommandsOfAClientThatHasGone) {
  start();
  rest(1);
  const std::size_t before = firings_in(options_.recording), asked = 50;
  const std::string line = "{\"command\":\"step_firing\"}\n";
  for (std::size_t sent = 0; sent < asked;) {
    const int client = connect_another();
    if (client < 0) continue;  // it has not got round to the last ones
    EXPECT_EQ(send(client, line.data(), line.size(), MSG_NOSIGNAL), static_cast<ssize_t>(line.size()));
    close(client);
    ++sent;
  }
  EXPECT_TRUE(eventually([&] { return firings_in(options_.recording) == before + asked; }));
  finish();
}

TEST_F(Controlled, HostileClientsDoNoHarm) {
  start();
  rest(1);
  const std::vector<std::string> talks{
      std::string(3'000'000, 'x'),                                  // no end of line
      std::string(500'000, '[') + "\n",                             // nested
      "{\"command\":\"breakpoints\",\"places\":[\"\xff\xfe\"]}\n",  // no UTF-8, which is in the answer
      "{\"id\":1e400,\"command\":\"speed\",\"value\":1e400}\n",
      "{\"id\":\"\xc3\",\"command\":{}}\n" + std::string(100, '\n'),
      std::string(1000, '\0'),
      "{\"command\":\"recording\"}"};  // half a line
  for (int round = 0; round < 300; ++round) {
    const int client = connect_another();
    if (client < 0) continue;
    const std::string& talk = talks[static_cast<std::size_t>(round) % talks.size()];
    send(client, talk.data(), talk.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    close(client);
  }
  std::vector<int> clients;
  for (int count = 0; count < 64; ++count) clients.push_back(connect_another());
  EXPECT_EQ(command({{"command", "pause"}}), "") << "it is still served";
  for (const int client : clients)
    if (client >= 0) close(client);
  finish();
  EXPECT_EQ(summary_.ended, "duration");
}

TEST_F(Controlled, APathThatIsNoTextAndAFolderThatHasGoneEndNothing) {
  const std::filesystem::path before = std::filesystem::current_path(),
                              gone = std::filesystem::path(folder_) / "gone";
  std::filesystem::create_directories(gone);
  std::filesystem::current_path(gone);
  options_.recording = "r\xff\xfe.tsr";
  start();
  std::filesystem::remove_all(gone);
  EXPECT_TRUE(rest(1).contains("recording"));
  EXPECT_NE(command({{"command", "breakpoints"}, {"places", {"nowhere"}}}), "");
  finish();
  std::filesystem::current_path(before);
  EXPECT_EQ(summary_.ended, "duration");
}

}  // namespace
}  // namespace tessera::testing
