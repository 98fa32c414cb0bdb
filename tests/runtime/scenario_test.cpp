#include "subsystem/scenario.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// No condition of `next` holds in that subsystem.
[[nodiscard]] std::string none_holds(const std::string& path) {
  return R"({"name": ")" + path + R"(.run.out none", "none_holds": ")" + path + R"("})";
}

/// Writes a scenario of that system's net. firings: names, or what none_holds returns.
[[nodiscard]] std::string written(TestSystem& system, const std::vector<std::string>& firings,
                                  std::string hash = "") {
  if (hash.empty()) hash = system.system().net_hash;
  std::string text = R"({"scenario": 1, "net_hash": ")" + hash + R"(", "firings": [)";
  for (std::size_t index = 0; index < firings.size(); ++index)
    text += (index > 0 ? ", " : "") +
            (firings[index].starts_with('{') ? firings[index] : '"' + firings[index] + '"');
  std::string file = scratch_file("scenario.json");
  std::ofstream(file) << text << "]}";
  return file;
}

[[nodiscard]] RunOptions following(const std::string& scenario, Duration duration) {
  RunOptions options = simulated(duration);
  options.scenario = scenario;
  options.recording = scratch_file("run");
  return options;
}

/// The firings of one subsystem, and its log lines, in order.
struct Story {
  std::vector<std::string> firings, lines;
};
[[nodiscard]] Story story_of(const RunOptions& options, TestSystem& system) {
  std::string error;
  const auto recording = read_recording(options.recording, error);
  EXPECT_TRUE(recording) << error;
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
  Story story;
  for (const Recording::Entry& entry : recording->entries) {
    if (entry.event.kind() == Event::Kind::firing)
      story.firings.push_back(recording->transitions.at(entry.event.subject).name);
    if (entry.event.kind() == Event::Kind::log) story.lines.push_back(entry.text);
  }
  return story;
}

const std::vector<std::string> one_round{"robot.a.t_in",   "robot.a.run.t1", "robot.a.run.snd.t1",
                                         "robot.a.run.t2", "robot.a.run.t3", "robot.a.run.rcv.t1"};

[[nodiscard]] std::vector<std::string> round_and(const std::vector<std::string>& more) {
  std::vector<std::string> all{"t_in", "robot.t_in"};
  all.insert(all.end(), one_round.begin(), one_round.end());
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(Scenario, ForcesAConditionThatWouldNotHold) {
  TestSystem system;
  int decided = 0;
  Script script;
  script.decide = [&](const ScriptState&) { return ++decided, Outcome::go_on; };
  system.add("robot.a", nets::alone, script, 10ms);
  const RunOptions options = following(written(system, round_and({"robot.a.run.t5"})), 1s);
  const RunSummary summary = run(system, options);
  EXPECT_EQ(summary.ended, "net ended");
  EXPECT_EQ(decided, 0) << "a forced condition is not evaluated";
  const Story story = story_of(options, system);
  EXPECT_EQ(story.lines.back(), "scenario 7/7: run.t5 (forced: terminal)");
}

TEST(Scenario, RunsFreelyAfterItsEndForAsLongAsWasAsked) {
  TestSystem system;
  system.add("robot.a", nets::alone, {}, 10ms);
  const RunSummary summary = run(system, following(written(system, round_and({"robot.a.run.t4"})), 50ms));
  EXPECT_EQ(summary.ended, "duration");
  EXPECT_FALSE(summary.failed);
  EXPECT_EQ(summary.simulated, 50ms);
  EXPECT_EQ(summary.subsystems.at(0).iterations, 5U);
}

TEST(Scenario, WaitsForReleasesAndForcesTheChoiceAmongSubsystems) {
  TestSystem system;
  const auto a = system.add("robot.a", nets::nb_sender, {}, 10ms);
  const auto b = system.add("robot.b", nets::b_receiver, {}, 10ms);
  system.connect(a, "x", b, "x", buffered);
  // b, which would take the value, is kept from starting while a overwrites its own.
  const std::vector<std::string> firings{"t_in",
                                         "robot.t_in",
                                         "robot.a.t_in",
                                         "robot.a.run.t1",
                                         "robot.a.run.snd.x.t1",
                                         "robot.a.run.snd.x.t2",
                                         "robot.a.run.t2",
                                         "robot.a.run.t3",
                                         "robot.a.run.rcv.t1",
                                         "robot.a.run.t4",
                                         "robot.a.run.t1",
                                         "robot.a.run.snd.x.t1o",
                                         "robot.a.run.snd.x.t2"};
  const RunOptions options = following(written(system, firings), 20ms);
  const RunSummary summary = run(system, options);
  EXPECT_EQ(summary.ended, "duration");
  const Story story = story_of(options, system);
  ASSERT_GE(story.firings.size(), firings.size());
  EXPECT_EQ(std::vector(story.firings.begin(), story.firings.begin() + std::ptrdiff_t(firings.size())),
            firings);
  EXPECT_EQ(summary.simulated, 30ms) << "the second round of a was released at 10 ms";
}

TEST(Scenario, TellsWhoIsStuckWhenItIsOver) {
  TestSystem system;
  system.add("robot.c", nets::alone, {}, 10ms);
  system.add("robot.a", nets::alone, {}, 10ms);
  const auto b = system.add("robot.b", nets::b_receiver, {}, 10ms);
  const auto d = system.add("robot.d", nets::nb_sender, {}, 10ms);
  system.connect(d, "x", b, "x", buffered);
  std::vector<std::string> firings{"t_in",           "robot.t_in",           "robot.d.t_in",
                                   "robot.d.run.t1", "robot.d.run.snd.x.t1", "robot.d.run.snd.x.t2",
                                   "robot.d.run.t2", "robot.d.run.t3",       "robot.d.run.rcv.t1",
                                   "robot.d.run.t5", "robot.d.t_run_0",      "robot.b.t_in",
                                   "robot.b.run.t1", "robot.b.run.snd.t1",   "robot.b.run.t2",
                                   "robot.b.run.t3", "robot.b.run.rcv.x.t1", "robot.b.run.rcv.x.t2",
                                   "robot.b.run.t4", "robot.b.run.t1",       "robot.b.run.snd.t1",
                                   "robot.b.run.t2", "robot.b.run.t3"};
  const RunSummary summary = run(system, following(written(system, firings), 100ms));
  EXPECT_TRUE(summary.failed);
  EXPECT_EQ(summary.ended,
            "duration; stuck since the scenario: robot.b at run.rcv.in waits for robot.d over 'x', which has "
            "ended");
}

TEST(Scenario, EndsWithTheFaultThatNoInitialConditionHolds) {
  TestSystem system;
  int routed = 0;
  Script script;
  script.route = [&](const ScriptState&, bool) { return ++routed, 0; };
  system.add("robot.a", nets::alone, script, 10ms);
  const RunOptions options =
      following(written(system, round_and({"robot.a.run.t5", none_holds("robot.a")})), 1s);
  const RunSummary summary = run(system, options);
  EXPECT_TRUE(summary.failed);
  EXPECT_EQ(summary.ended, "stopped: robot.a: no condition of `next` holds");
  EXPECT_EQ(routed, 0);
}

struct Wrong {
  const char* name;
  std::vector<std::string> firings;
  const char* hash;
  const char* complaint;
};

TEST(Scenario, OfAnotherNetOrWithUnknownNamesIsRefused) {
  const Wrong cases[] = {{"another net", {}, "0123", "is a scenario of another net (0123"},
                         {"a name", {"robot.a.run.t9"}, "", "names 'robot.a.run.t9', which is no transition"},
                         {"a subsystem", {none_holds("robot.z")}, "", "names 'robot.z.run.out none'"}};
  for (const Wrong& wrong : cases) {
    SCOPED_TRACE(wrong.name);
    TestSystem system;
    system.add("robot.a", nets::alone, {}, 10ms);
    const RunOptions options = following(written(system, wrong.firings, wrong.hash), 1s);
    std::string error;
    EXPECT_FALSE(execute(system.system(), options, error));
    EXPECT_NE(error.find(wrong.complaint), std::string::npos) << error;
  }
}

TEST(Scenario, ThatIsNoFileOfItsKindIsRefused) {
  TestSystem system;
  system.add("robot.a", nets::alone, {}, 10ms);
  std::string error;
  EXPECT_FALSE(execute(system.system(), following("/nowhere/scenario.json", 1s), error));
  EXPECT_EQ(error, "cannot read '/nowhere/scenario.json'");
  const std::string file = scratch_file("scenario.json");
  std::ofstream(file) << "[1, 2";
  EXPECT_FALSE(execute(system.system(), following(file, 1s), error));
  EXPECT_NE(error.find("is no scenario"), std::string::npos) << error;
  RunOptions options = steady(1s);
  options.scenario = file;
  EXPECT_FALSE(execute(system.system(), options, error));
  EXPECT_EQ(error, "a scenario needs the simulated clock");
}

TEST(Scenario, ThatTheControllerCannotFollowSaysWhere) {
  TestSystem system;
  system.add("robot.a", nets::alone, {}, 10ms);
  const RunSummary summary = run(system, following(written(system, {"robot.a.t_in", "robot.a.run.t3"}), 1s));
  EXPECT_TRUE(summary.failed);
  EXPECT_NE(summary.ended.find("the scenario cannot be followed: robot.a.run.t3 cannot fire"),
            std::string::npos)
      << summary.ended;
}

}  // namespace
}  // namespace tessera::testing
