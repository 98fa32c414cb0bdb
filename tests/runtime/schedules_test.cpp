#include "run/schedules.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

[[nodiscard]] ScheduleReport try_all(TestSystem& system, const RunOptions& options,
                                     const ScheduleRequest& request) {
  std::string error;
  const std::optional<ScheduleReport> report = try_schedules(system.system(), options, request, error);
  EXPECT_TRUE(report) << error;
  return report.value_or(ScheduleReport{});
}

[[nodiscard]] ScheduleOutcome outcome_of(const ScheduleReport& report, const std::string& kind,
                                         const std::string& name) {
  const auto found = report.outcomes.find({kind, name});
  return found == report.outcomes.end() ? ScheduleOutcome{} : found->second;
}

TEST(ScheduleReport, NamesChecksThatNeverFailed) {
  ScheduleReport report;
  report.add({.seed = 1,
              .failed = true,
              .interrupted = false,
              .simulated = 1s,
              .firings = 5,
              .ended = "a check failed: apart",
              .events = {{.kind = "assertion", .name = "apart", .at_s = 0.5, .text = "apart: at 0.500 s"}}});
  RunOptions options;
  report.add_checks(options);
  options.world.emplace().checks = R"({"measures": {}})";
  report.add_checks(options);
  EXPECT_EQ(report.outcomes.size(), 1U);
  // Faults of the system go by what stands before a colon.
  options.world->checks = R"({"checks": [{"name": "apart"}, {"name": "robot: upright"}]})";
  options.use_checks = {{"battery", "energy", 200}};
  report.add_checks(options);
  EXPECT_EQ(report.outcomes.size(), 3U);
  EXPECT_EQ(report.outcomes.at({"assertion", "battery"}).runs, 0U);
  EXPECT_EQ(outcome_of(report, "assertion", "apart").runs, 1U);
  EXPECT_EQ(report.outcomes.at({"assertion", "robot"}).runs, 0U);
  EXPECT_NE(schedules_text(report).find("assertion robot: in none of 1 runs\n"), std::string::npos);
}

/// Two subsystems that write and read a variable outside the net in two steps: a race that only some
/// interleavings of their firings show.
struct Race : ::testing::Test {
  TestSystem system;
  int holder = 0;
  Race() {
    for (const int self : {1, 2}) {
      Script script;
      script.call = [this, self](ScriptState& state) {
        // The run before may have ended while a subsystem held it.
        if (state.context.iteration <= 1) holder = 0;
        state.context.assert_that(holder == 0 || holder == self, "{} takes what {} holds", self, holder);
        holder = self;
      };
      script.decide = [this](const ScriptState&) {  // at the end of the iteration
        holder = 0;
        return Outcome::go_on;
      };
      system.add(self == 1 ? "robot.a" : "robot.b", nets::alone, script, 10ms);
    }
  }
};

TEST(Schedules, OfASystemWithoutRacesAllEndWell) {
  TestSystem system;
  Script counts;
  counts.call = [](ScriptState& state) { state.context.assert_that(true, "always"); };
  const auto a = system.add("robot.a", nets::nb_sender, counts, 10ms);
  const auto b = system.add("robot.b", nets::nb_receiver, {}, 10ms);
  system.connect(a, "x", b, "x", buffered);
  RunOptions options = simulated(100ms);
  options.seed = 5;
  for (const unsigned jobs : {1U, 3U}) {
    const ScheduleReport report = try_all(system, options, {.count = 20, .jobs = jobs});
    EXPECT_EQ(report.failed, 0u);
    EXPECT_EQ(report.tried, 20u);
    EXPECT_EQ(report.jobs, jobs);
    EXPECT_EQ(report.ran, (std::vector<SeedRange>{{5, 25}}));
    EXPECT_EQ(report.simulated, 2s);
    EXPECT_GT(report.firings, 20u * 10 * 8);
    EXPECT_TRUE(report.outcomes.empty());
    EXPECT_TRUE(schedules_text(report).starts_with("20 of 20 schedules from seed 5 on, none fails"));
  }
}

TEST(Schedules, NoneAtAllIsAResultToo) {
  TestSystem system;
  system.add("robot.a", nets::alone, {}, 10ms);
  const ScheduleReport report = try_all(system, simulated(100ms), {});
  EXPECT_EQ(report.tried, 0u);
  EXPECT_TRUE(report.ran.empty());
  EXPECT_EQ(nlohmann::json::parse(schedules_json(report)).at("kinds").size(), schedule_event_kinds().size());
}

TEST(Schedules, AnEntryOfNextThatIsMissingFailsAll) {
  TestSystem system;
  Script script;
  script.decide = [](const ScriptState&) { return Outcome::error; };
  script.route = [](const ScriptState&, bool) { return -1; };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  const ScheduleReport report = try_all(system, simulated(100ms), {.count = 20, .jobs = 2});
  EXPECT_EQ(report.tried, 20u);
  EXPECT_EQ(report.failed, 20u);
  const ScheduleOutcome net = outcome_of(report, "net", "robot.a");
  EXPECT_EQ(net.runs, 20u);
  EXPECT_EQ(net.failed, 20u);
  EXPECT_EQ(net.first_seed, 1u);
  EXPECT_EQ(report.kinds.at("net").runs, 20u);
  EXPECT_EQ(report.kinds.at("deadlock").runs, 0u);
  const auto json = nlohmann::json::parse(schedules_json(report));
  EXPECT_EQ(json.at("failure").at("seed"), 1);
  EXPECT_EQ(json.at("failure").at("ended"), "stopped: robot.a: no condition of `next` holds");
  EXPECT_EQ(json.at("ran"), nlohmann::json::array({{1, 21}}));
}

TEST(Schedules, AHangIsAFailure) {
  TestSystem system;
  const auto a = system.add("robot.waits", nets::b_receiver, {});
  system.connect(a, "", a, "x", buffered);  // no behaviour sends
  const ScheduleReport report = try_all(system, simulated(100ms), {.count = 3});
  EXPECT_EQ(report.failed, 3u);
  const ScheduleOutcome deadlock = outcome_of(report, "deadlock", "");
  EXPECT_EQ(deadlock.runs, 3u);
  EXPECT_NE(deadlock.text.find("nothing can ever happen again"), std::string::npos);
}

TEST(Schedules, AFaultThatIsRoutedIsCountedAndFailsNothing) {
  TestSystem system;
  Script script;
  script.call = [](ScriptState& state) {
    if (state.context.iteration == 2) throw std::runtime_error("lost the line");
  };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  const ScheduleReport report = try_all(system, simulated(100ms), {.count = 4, .jobs = 2});
  EXPECT_EQ(report.failed, 0u);
  const ScheduleOutcome thrown = outcome_of(report, "exception", "robot.a");
  EXPECT_EQ(thrown.runs, 4u);
  EXPECT_EQ(thrown.failed, 0u);
  EXPECT_NE(thrown.text.find("lost the line"), std::string::npos);
}

TEST(Schedules, CountTheRunsWithAPlantedFault) {
  TestSystem system;
  system.add("robot.a", nets::two_behaviours, {}, 10ms);  // stays in the first behaviour
  RunOptions options = simulated(100ms);
  options.inject = {"robot.a.first:stall=1ms@any", "robot.a.second:throw@any"};
  const ScheduleReport report = try_all(system, options, {.count = 4, .jobs = 2});
  const InjectionCount entered = report.injected.at("robot.a.first:stall=1ms@any");
  EXPECT_EQ(entered.runs + entered.missed, 4U);
  EXPECT_GT(entered.runs, 0U);
  const InjectionCount never = report.injected.at("robot.a.second:throw@any");
  EXPECT_EQ(never.runs, 0U);
  EXPECT_EQ(never.missed, 4U);
  EXPECT_NE(schedules_text(report).find("injected robot.a.second:throw@any: in 0 of 4 runs\n"),
            std::string::npos);
  const auto json = nlohmann::json::parse(schedules_json(report));
  EXPECT_EQ(json.at("injected").at(1),
            (nlohmann::json{{"fault", "robot.a.second:throw@any"}, {"runs", 0}, {"missed", 4}}));
}

// The seed of a run is in no place that a script sees, so the memory of the process stands in for it: the
// third run of each process dies.
TEST(Schedules, ADeathLosesOneRunAndIsNamed) {
  TestSystem system;
  Script script;
  int runs = 0;
  script.call = [&](ScriptState& state) {
    if (state.context.iteration != 1) return;
    if (++runs == 3) raise(SIGSEGV);
  };
  system.add("robot.a", nets::alone, script, 10ms);
  const ScheduleReport report = try_all(system, simulated(50ms), {.count = 7, .jobs = 1});
  EXPECT_EQ(report.tried, 7u);
  EXPECT_EQ(report.failed, 2u);
  EXPECT_EQ(report.ran, (std::vector<SeedRange>{{1, 8}}));
  const ScheduleOutcome crash = outcome_of(report, "crash", "");
  EXPECT_EQ(crash.runs, 2u);
  EXPECT_EQ(crash.first_seed, 3u);
  EXPECT_NE(crash.text.find("robot.a"), std::string::npos) << crash.text;
  EXPECT_NE(crash.text.find("SIGSEGV"), std::string::npos) << crash.text;
  EXPECT_EQ(report.not_repeated, (std::vector<std::uint64_t>{3}))
      << "alone it is the first run of its process";
}

TEST(Schedules, ASystemThatCannotStartSaysWhy) {
  TestSystem system;
  system.add("robot.a", nets::alone, {}, 10ms);
  RunOptions options = simulated(10ms);
  options.parameters = {{"nothing.of.it", "1"}};
  std::string error;
  EXPECT_FALSE(try_schedules(system.system(), options, {.count = 5, .jobs = 2}, error));
  EXPECT_NE(error.find("nothing.of.it"), std::string::npos) << error;

  options.parameters.clear();
  options.seed = UINT64_MAX - 2;
  EXPECT_EQ(try_all(system, options, {.count = 3}).tried, 3u);
  EXPECT_FALSE(try_schedules(system.system(), options, {.count = 4}, error));
}

TEST(Schedules, FiringsAreCountedAsARecordingHasThem) {
  TestSystem system;
  const auto a = system.add("robot.a", nets::nb_sender, {}, 10ms);
  const auto b = system.add("robot.b", nets::nb_receiver, {}, 10ms);
  system.connect(a, "x", b, "x", buffered);
  RunOptions options = simulated(100ms);
  const ScheduleReport report = try_all(system, options, {.count = 3, .jobs = 2, .coverage = true});

  std::map<std::string, std::uint64_t> recorded;
  options.interleave = true;
  options.recording = scratch_file("counted");
  for (options.seed = 1; options.seed <= 3; ++options.seed) {
    static_cast<void>(run(system, options));
    std::string error;
    const std::optional<Recording> recording = read_recording(options.recording, error);
    ASSERT_TRUE(recording) << error;
    for (const Recording::Transition& transition : recording->transitions) recorded[transition.name];
    for (const Recording::Entry& entry : recording->entries)
      if (entry.event.kind() == Event::Kind::firing)
        ++recorded[recording->transitions[entry.event.subject].name];
  }
  const std::map<std::string, std::uint64_t> counted(report.transitions.begin(), report.transitions.end());
  EXPECT_EQ(counted, recorded);
}

TEST(ScheduleReport, RunsThatEndInAnyOrderJoinTheirRanges) {
  ScheduleReport report;
  for (const std::uint64_t seed : {4U, 1U, 9U, 2U, 10U, 3U})
    report.add({.seed = seed, .ended = "duration", .events = {}});
  EXPECT_EQ(report.ran, (std::vector<SeedRange>{{1, 5}, {9, 11}}));
}

TEST(ScheduleReport, TheLowestSeedIsTheFirstAndAKindCountsARunOnce) {
  ScheduleReport report;
  for (const std::uint64_t seed : {7U, 3U, 5U})
    report.add({.seed = seed,
                .failed = true,
                .ended = "stopped",
                .events = {{"device", "robot.b", 0.5, "late"}, {"device", "robot.a", 0.25, "early"}}});
  EXPECT_EQ(report.kinds.at("device").runs, 3u);
  EXPECT_EQ(report.kinds.at("device").first_seed, 3u);
  EXPECT_EQ(report.kinds.at("device").text, "early");
  EXPECT_EQ(outcome_of(report, "device", "robot.b").runs, 3u);
  ASSERT_TRUE(report.first_failure);
  EXPECT_EQ(report.first_failure->seed, 3u);
}

TEST(ScheduleResult, ComesBackFromItsLine) {
  const ScheduleResult result{.seed = UINT64_MAX,
                              .failed = true,
                              .interrupted = true,
                              .simulated = 1500ms,
                              .firings = 12,
                              .ended = "stopped: \"a\"\nb",
                              .events = {{"assertion", "robot.a", 0.1, "x\ny"}},
                              .injected = {{"robot.a:nan@any", true}, {"robot.b:nan@any", false}}};
  const std::string line = to_line(result);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const std::optional<ScheduleResult> back = from_line(line);
  ASSERT_TRUE(back);
  EXPECT_EQ(to_line(*back), line);
  EXPECT_EQ(back->seed, UINT64_MAX);
  EXPECT_FALSE(from_line("[1, 2"));
}

TEST_F(Race, IsFoundOnlyByInterleavingAndTheSeedMakesItAgain) {
  RunOptions options = simulated(1s);
  EXPECT_FALSE(run(system, options).failed) << "an iteration that waits for nothing is never interrupted";
  const ScheduleReport report = try_all(system, options, {.count = 100});
  ASSERT_TRUE(report.first_failure);
  EXPECT_NE(report.first_failure->ended.find("broken assertion: "), std::string::npos);
  EXPECT_EQ(report.kinds.at("assertion").runs, report.failed);
  EXPECT_TRUE(report.not_repeated.empty());

  holder = 0;
  options.interleave = true;
  options.seed = report.first_failure->seed;
  options.recording = scratch_file("again");
  const RunSummary again = run(system, options);
  EXPECT_TRUE(again.failed);
  EXPECT_EQ(again.ended, report.first_failure->ended);
  EXPECT_EQ(seconds(again.simulated), report.first_failure->at_s);
}

}  // namespace
}  // namespace tessera::testing
