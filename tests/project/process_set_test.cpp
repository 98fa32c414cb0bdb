#include "project/process/process_set.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tessera::project {
namespace {

using namespace std::chrono_literals;

/// The output and ends of a set of processes; `on_line` may act on it.
struct Watched : ProcessSetListener {
  std::vector<std::size_t> order;
  std::vector<pid_t> pids;
  std::vector<ProcessEnd> ends;
  std::map<std::size_t, std::vector<std::string>> lines;
  std::vector<int> stops;
  std::size_t given_up = 0;
  std::function<void(std::size_t, std::string_view)> on_line;

  void started(std::size_t process, unsigned, pid_t pid) override {
    order.push_back(process);
    pids.push_back(pid);
  }
  void said(std::size_t process, std::string_view line) override {
    lines[process].emplace_back(line);
    if (on_line) on_line(process, line);
  }
  void ended(const ProcessEnd& end, std::optional<std::chrono::milliseconds> again_in) override {
    ends.push_back(end);
    if (!again_in && end.exit.code != 0 && !end.asked) ++given_up;
  }
  void stopping(int signal) override { stops.push_back(signal); }
  void waits_for(const std::vector<std::size_t>&) override {}

  [[nodiscard]] bool all_are_gone() const {
    return std::ranges::all_of(pids, [](pid_t pid) { return kill(pid, 0) != 0; });
  }
};

Command shell(const std::string& script) { return {"sh", "-c", script}; }
/// Says when it is ready and stops as a controller does.
const std::string obedient =
    "trap 'echo safe; exit 130' INT; trap 'echo safe; exit 143' TERM; echo ready; while :; do sleep 0.02; "
    "done";

TEST(ProcessSet, RunsAllToTheirEndsAndReadsEveryLine) {
  Watched watched;
  ProcessSet set(
      3,
      [](std::size_t process, unsigned) {
        return shell("echo one; echo two >&2; printf 'no end " + std::to_string(process) + "'");
      },
      {}, watched);
  EXPECT_EQ(set.run(), 0);
  EXPECT_EQ(watched.order, (std::vector<std::size_t>{0, 1, 2}));
  for (std::size_t process = 0; process < 3; ++process) {
    EXPECT_EQ(watched.lines[process],
              (std::vector<std::string>{"one", "two", "no end " + std::to_string(process)}));
    EXPECT_EQ(set.ends()[process].exit.code, 0);
  }
  EXPECT_TRUE(watched.stops.empty());
}

TEST(ProcessSet, OneSignalStopsFiftyInAnOrderlyWay) {
  constexpr std::size_t count = 50;
  Watched watched;
  std::set<std::size_t> ready;
  watched.on_line = [&](std::size_t process, std::string_view line) {
    if (line == "ready" && ready.insert(process).second && ready.size() == count) kill(getpid(), SIGINT);
  };
  ProcessSet set(
      count, [](std::size_t, unsigned) { return shell(obedient); }, {}, watched);
  EXPECT_EQ(set.run(), SIGINT);
  EXPECT_EQ(watched.stops, std::vector<int>{SIGINT});
  for (std::size_t process = 0; process < count; ++process) {
    EXPECT_EQ(watched.lines[process].back(), "safe");
    EXPECT_EQ(set.ends()[process].exit.code, 130);
    EXPECT_TRUE(set.ends()[process].asked);
  }
  EXPECT_TRUE(watched.all_are_gone());
}

TEST(ProcessSet, IfOneIsKilledTheOthersAreStopped) {
  Watched watched;
  std::set<std::size_t> ready;
  watched.on_line = [&](std::size_t process, std::string_view line) {
    if (line == "ready" && ready.insert(process).second && ready.size() == 3) kill(watched.pids[1], SIGKILL);
  };
  ProcessSet set(
      3, [](std::size_t, unsigned) { return shell(obedient); }, {}, watched);
  EXPECT_EQ(set.run(), 0) << "nobody sent a signal to stop";
  EXPECT_EQ(watched.stops, std::vector<int>{0});
  EXPECT_EQ(watched.ends.front().process, 1U);
  EXPECT_EQ(watched.ends.front().exit.code, 128 + SIGKILL);
  EXPECT_FALSE(watched.ends.front().asked);
  EXPECT_EQ(set.ends()[0].exit.code, 143);
  EXPECT_TRUE(watched.all_are_gone());
}

TEST(ProcessSet, IfOneFailsTheOthersMayGoOn) {
  Watched watched;
  ProcessSet set(
      2,
      [](std::size_t process, unsigned) { return shell(process == 0 ? "exit 3" : "sleep 0.2; echo done"); },
      {.restarts = false, .stops_all = false}, watched);
  EXPECT_EQ(set.run(), 0);
  EXPECT_EQ(set.ends()[0].exit.code, 3);
  EXPECT_EQ(watched.lines[1], std::vector<std::string>{"done"});
  EXPECT_TRUE(watched.stops.empty());
}

TEST(ProcessSet, OneThatFailsIsStartedAgainButNotForEver) {
  Watched watched;
  const FailurePolicy policy{.restarts = true, .stops_all = false, .most_restarts = 3, .first_pause = 1ms};
  ProcessSet set(
      2,
      [](std::size_t process, unsigned start) {
        return shell(process == 0 && start == 3 ? "echo third" : "kill -SEGV $$");
      },
      policy, watched);
  EXPECT_EQ(set.run(), 0);
  EXPECT_EQ(set.ends()[0].start, 3U);
  EXPECT_EQ(set.ends()[0].exit.code, 0);
  EXPECT_EQ(set.ends()[1].start, 4U) << "once, and three times again";
  EXPECT_EQ(set.ends()[1].exit.code, 128 + SIGSEGV);
  EXPECT_EQ(watched.given_up, 1U);
}

TEST(ProcessSet, AProgramThatDoesNotExistStopsTheOthers) {
  Watched watched;
  ProcessSet set(
      2,
      [](std::size_t process, unsigned) {
        return process == 0 ? shell(obedient) : Command{"/no/such/program"};
      },
      {}, watched);
  EXPECT_THROW(set.run(), std::runtime_error);
  EXPECT_TRUE(watched.all_are_gone());
}

}  // namespace
}  // namespace tessera::project
