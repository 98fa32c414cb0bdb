// Two processes of one system, each with its own threads, over datagrams that get lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "links_nets.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

namespace tessera::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr double most = 500;

/// Waits for each send, and ends after the last.
void add_talker(TestSystem& system) {
  static double written = 0;
  system.add(
      "robot.talk", nets::far_b_sender,
      {.call = [](ScriptState& state) { state.out_x = ++written; },
       .decide = [](const ScriptState&) { return written == most ? Outcome::terminal : Outcome::go_on; }});
}

/// Fails if a value is read twice or out of order, and ends after the last.
void add_listener(TestSystem& system) {
  static double last = 0;
  system.add("base.listen", nets::far_b_receiver,
             {.call = [](ScriptState&) {},
              .decide =
                  [](const ScriptState& state) {
                    if (state.x != last + 1) std::abort();
                    last = state.x;
                    return last == most ? Outcome::terminal : Outcome::go_on;
                  }});
}

/// Runs one process of the system and leaves; its exit code says how it ended.
[[noreturn]] void run_process(const char* name, const std::string& recording, std::uint64_t incarnation) {
  TestSystem system;
  add_talker(system);
  add_listener(system);
  system.connect(0, "x", 1, "x", networked_single);
  system.deploy({0, 1});
  RunOptions options = steady(50s);
  options.network.process = name;
  options.network.library = TEST_CARRIER;
  options.network.incarnation = incarnation;
  options.recording = recording;
  std::string error;
  const std::optional<RunSummary> summary = execute(system.system(), options, error);
  if (!summary) std::fprintf(stderr, "%s\n", error.c_str());
  if (summary && summary->ended != "net ended")
    std::fprintf(stderr, "%s: %s\n", name, summary->ended.c_str());
  std::_Exit(summary && summary->ended == "net ended" && !summary->failed ? 0 : 1);
}

[[nodiscard]] pid_t start(const char* name, const std::string& recording, std::uint64_t incarnation) {
  const pid_t child = fork();
  if (child == 0) run_process(name, recording, incarnation);
  return child;
}

[[nodiscard]] int exit_code_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// A port that was free a moment ago, for the first process; the second takes the next.
[[nodiscard]] std::string free_port() { return std::to_string(20'000 + getpid() % 20'000); }

[[nodiscard]] std::vector<std::uint32_t> numbers_of(const std::string& file, const char* transition) {
  std::string error;
  const auto recording = read_recording(file, error);
  EXPECT_TRUE(recording) << error;
  std::vector<std::uint32_t> numbers;
  if (recording)
    for (const Recording::Entry& entry : recording->entries)
      if (entry.event.kind() == Event::Kind::firing &&
          recording->transitions[entry.event.subject].name.ends_with(transition))
        numbers.push_back(entry.event.version);
  return numbers;
}

TEST(Processes, HandEachOtherEveryValueOnceOverANetworkThatLosesAndRepeats) {
  setenv("TEST_LINKS_PORT", free_port().c_str(), 1);
  const std::string talker = scratch_file("talker.tsr"), listener = scratch_file("listener.tsr");
  const pid_t first = start("p1", listener, 20);
  const pid_t second = start("p0", talker, 10);
  EXPECT_EQ(exit_code_of(second), 0);
  EXPECT_EQ(exit_code_of(first), 0);

  std::string error;
  const auto recording = read_recording(talker, error);
  ASSERT_TRUE(recording) << error;
  ASSERT_TRUE(recording->process);
  EXPECT_EQ(recording->process->name, "p0");
  EXPECT_EQ(recording->process->incarnation, 10U);
  EXPECT_EQ(recording->instances.size(), 2U) << "numbers are those of the whole system";
  std::vector<std::string> peers;
  for (const Recording::Entry& entry : recording->entries) {
    if (entry.event.kind() == Event::Kind::peer) peers.push_back(entry.text);
    if (entry.event.kind() == Event::Kind::firing) {
      const std::string& name = recording->transitions[entry.event.subject].name;
      EXPECT_TRUE(name.starts_with("robot.")) << name << " is not of this process";
    }
  }
  EXPECT_EQ(peers, (std::vector<std::string>{"robot.talk.x->base.listen.x\n20"}));
  const std::vector<std::uint32_t> acknowledged = numbers_of(talker, "snd.x.t3"),
                                   read = numbers_of(listener, "rcv.x.t1");
  EXPECT_EQ(acknowledged.size(), static_cast<std::size_t>(most));
  EXPECT_EQ(acknowledged, read);
}

TEST(Processes, OfALibraryThatOffersNoNetworkItIsSaid) {
  unsetenv("TEST_LINKS_PORT");
  TestSystem system;
  add_talker(system);
  add_listener(system);
  system.connect(0, "x", 1, "x", networked_single);
  system.deploy({0, 1});
  RunOptions options = steady(1s);
  options.network.process = "p0";
  options.network.library = TEST_CARRIER;
  std::string error;
  EXPECT_FALSE(execute(system.system(), options, error));
  EXPECT_EQ(error, "the network: the test has given no port");
}

}  // namespace
}  // namespace tessera::testing
