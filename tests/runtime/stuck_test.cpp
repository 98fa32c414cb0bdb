#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <vector>

#include "../environment.hpp"
#include "blocks.hpp"
#include "nets.hpp"
#include "nets/flat_net.hpp"
#include "recorder/recorder.hpp"
#include "run/schedules.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

constexpr Behaviour run_only[] = {{"run"}};
constexpr Behaviour first_second[] = {{"first"}, {"second"}};
constexpr Port sends_x[] = {{"x", Side::send, "x"}};
constexpr Port relays[] = {{"x", Side::receive, "x"}, {"y", Side::send, "y"}};

// Sends x in `first`, and no value in `second`, from which no way leads back.
constexpr named::Place leaver_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("first"), BEHAVIOUR_PLACES("second"), SEND_PLACES("first", "x")};
const named::Transition leaver_transitions[] = {ENTER("first"),
                                                BEHAVIOUR_TRANSITIONS("first"),
                                                NB_SEND("first", "x", "first.snd.in", "first.snd.out"),
                                                NO_RECEIVE("first"),
                                                BEHAVIOUR_TRANSITIONS("second"),
                                                NO_SEND("second"),
                                                NO_RECEIVE("second"),
                                                NEXT("first", 0, "second"),
                                                NEXT("second", 0, "second")};
const SubsystemNet leaver = numbered(first_second, sends_x, leaver_places, leaver_transitions);

// Sends y, blocking, then receives x, blocking.
constexpr named::Place relay_places[] = {{"in"},
                                         {"out"},
                                         BEHAVIOUR_PLACES("run"),
                                         SEND_PLACES("run", "y"),
                                         WAIT_PLACE("run", "y"),
                                         RECEIVE_PLACES("run", "x")};
const named::Transition relay_transitions[] = {ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NEXT_END("run", 0),
                                               B_SEND("run", "y", "run.snd.in", "run.snd.out"),
                                               B_RECEIVE_ACK("run", "x", "run.rcv.in", "run.rcv.out")};
const SubsystemNet relay = numbered(run_only, relays, relay_places, relay_transitions);

/// Ends, or goes on to its other behaviour, after so many iterations; 0: never.
[[nodiscard]] Script for_iterations(std::uint64_t count) {
  Script script;
  script.decide = [count](const ScriptState& state) {
    return count != 0 && state.context.iteration + 1 >= count ? Outcome::terminal : Outcome::go_on;
  };
  return script;
}

TEST(Stuck, WhoWaitsForOneThatHasEndedIsNamedThoughOthersRun) {
  for (const bool real_time : {false, true}) {
    TestSystem system;
    const auto a = system.add("robot.a", nets::nb_sender, for_iterations(3), 10ms);
    const auto b = system.add("robot.b", nets::b_receiver, Script{});
    system.add("robot.c", nets::alone, Script{}, 10ms);
    system.connect(a, "x", b, "x", buffered);
    const RunSummary summary = run(system, real_time ? steady(200ms) : simulated(200ms));
    EXPECT_TRUE(summary.failed);
    EXPECT_TRUE(
        summary.ended.starts_with("duration; stuck for good: robot.b at run.rcv.in waits for robot.a over "
                                  "'x', which has ended (since 0.0"))
        << summary.ended;
  }
}

TEST(Stuck, IsAWarningWhereItIsAccepted) {
  TestSystem system;
  const auto a = system.add("robot.a", nets::nb_sender, for_iterations(3), 10ms);
  const auto b = system.add("robot.b", nets::b_receiver, Script{});
  system.add("robot.c", nets::alone, Script{}, 10ms);
  system.connect(a, "x", b, "x", buffered);
  RunOptions options = simulated(200ms);
  options.accept_stuck = true;
  const RunSummary summary = run(system, options);
  EXPECT_FALSE(summary.failed);
  EXPECT_EQ(summary.ended, "duration");
  ASSERT_EQ(summary.warnings.size(), 1U);
  EXPECT_TRUE(summary.warnings[0].starts_with("stuck for good: robot.b")) << summary.warnings[0];
}

TEST(Stuck, IsToldBesideACheckThatHasFailed) {
  for (const std::uint64_t ends_after : {3, 0}) {
    TestSystem system;
    const auto a = system.add("robot.a", nets::nb_sender, for_iterations(ends_after), 10ms);
    const auto b = system.add("robot.b", nets::b_receiver, Script{});
    system.add("robot.c", nets::alone, Script{}, 10ms);
    system.connect(a, "x", b, "x", buffered);
    constexpr Resource resources[] = {{"energy", "J"}};
    System tables = system.system();
    tables.resources = resources;
    RunOptions options = simulated(200ms);
    options.use_checks = {{"battery", "energy", -1}};
    std::string error;
    const std::optional<RunSummary> summary = execute(tables, options, error);
    ASSERT_TRUE(summary) << error;
    EXPECT_TRUE(summary->ended.ends_with("; a check failed: battery")) << summary->ended;
    const bool is_stuck = ends_after > 0;
    EXPECT_EQ(summary->ended.find("stuck for good: robot.b") != std::string::npos, is_stuck)
        << summary->ended;
    EXPECT_EQ(summary->failure, is_stuck ? RunSummary::Failure::stuck : RunSummary::Failure::check);
  }
}

TEST(Stuck, WhoWaitsForOneThatNeverSendsAgainIsNamed) {
  TestSystem system;
  const auto a = system.add("robot.a", leaver, for_iterations(3), 10ms);
  const auto b = system.add("robot.b", nets::b_receiver, Script{});
  system.connect(a, "x", b, "x", buffered);
  const RunSummary summary = run(system, simulated(200ms));
  EXPECT_TRUE(summary.failed);
  EXPECT_NE(summary.ended.find("stuck for good: robot.b at run.rcv.in waits for robot.a"), std::string::npos)
      << summary.ended;
}

TEST(Stuck, ACircleOfThreeIsNamedThoughAnotherRuns) {
  for (const bool real_time : {false, true}) {
    TestSystem system;
    std::vector<std::uint32_t> ring;
    for (const char* path : {"robot.a", "robot.b", "robot.c"})
      ring.push_back(system.add(path, relay, Script{}));
    system.add("robot.d", nets::alone, Script{}, 10ms);
    for (std::size_t at = 0; at < ring.size(); ++at)
      system.connect(ring[at], "y", ring[(at + 1) % ring.size()], "x", acknowledged);
    const RunSummary summary = run(system, real_time ? steady(100ms) : simulated(100ms));
    EXPECT_TRUE(summary.failed);
    for (const char* path : {"robot.a at", "robot.b at", "robot.c at"})
      EXPECT_NE(summary.ended.find(path), std::string::npos) << summary.ended;
    EXPECT_EQ(summary.ended.find("robot.d at"), std::string::npos) << summary.ended;
  }
}

TEST(Stuck, WhoHasATimeoutOrAPeerThatIsOnlySlowIsNotNamed) {
  for (const SubsystemNet* receiver : {&nets::b_receiver, &nets::b_receiver_timed}) {
    const bool slow = receiver == &nets::b_receiver;
    TestSystem system;
    const auto a = system.add("robot.a", nets::nb_sender, for_iterations(slow ? 0 : 3), slow ? 3s : 10ms);
    const auto b = system.add("robot.b", *receiver, Script{});
    system.connect(a, "x", b, "x", buffered, 0s, slow ? 0s : 10ms);
    const RunSummary summary = run(system, simulated(5s));
    EXPECT_EQ(summary.ended, "duration");
    EXPECT_FALSE(summary.failed);
  }
}

TEST(Stuck, TheDevicesOfAStuckEffectorGetTheSafeCommandWhenItIsNoticed) {
  for (const bool real_time : {false, true}) {
    TestSystem system;
    Script driver;
    driver.acts = true;
    driver.call = [](ScriptState& state) { state.command = 5; };
    // One that has ended makes the devices safe by itself.
    const auto a = system.add("robot.a", real_time ? nets::nb_sender : leaver, for_iterations(3), 10ms);
    const auto b = system.add("robot.b", nets::b_receiver, driver, 0s, 0s, Kind::effector);
    system.add("robot.c", nets::alone, Script{}, 10ms);
    system.connect(a, "x", b, "x", buffered);
    const RunSummary summary = run(system, real_time ? steady(2s) : simulated(10s));
    EXPECT_TRUE(summary.failed);
    ASSERT_GE(system.devices.commands.size(), 2U);
    // Once when it was noticed, once at the end.
    EXPECT_EQ(system.devices.commands.back(), -1);
    EXPECT_EQ(system.devices.commands.at(system.devices.commands.size() - 2), -1);
  }
}

TEST(Stuck, AScheduleThatLeavesSomebodyStuckFails) {
  TestSystem system;
  const auto a = system.add("robot.a", nets::nb_sender, for_iterations(3), 10ms);
  const auto b = system.add("robot.b", nets::b_receiver, Script{});
  system.add("robot.c", nets::alone, Script{}, 10ms);
  system.connect(a, "x", b, "x", buffered);
  std::string error;
  const auto report = try_schedules(system.system(), simulated(200ms), {.count = 10}, error);
  ASSERT_TRUE(report) << error;
  EXPECT_EQ(report->failed, 10U);
  EXPECT_EQ(report->kinds.at("stuck for good").runs, 10U);
  EXPECT_NE(schedules_text(*report).find("stuck for good: robot.b"), std::string::npos)
      << schedules_text(*report);
}

// -------------------------------------------------------------------------------------------- an oracle

using Marking = std::vector<bool>;

[[nodiscard]] Marking final_marking(const std::string& file, const FlatNet& net) {
  Marking marking;
  for (const FlatNet::FlatPlace& place : net.places) marking.push_back(place.tokens > 0);
  std::string error;
  const std::optional<Recording> recording = read_recording(file, error);
  if (!recording) throw std::runtime_error(error);
  for (const Recording::Entry& entry : recording->entries) {
    if (entry.event.kind() != Event::Kind::firing) continue;
    for (const std::uint32_t place : net.transitions.at(entry.event.subject).inputs) marking[place] = false;
    for (const std::uint32_t place : net.transitions.at(entry.event.subject).outputs) marking[place] = true;
  }
  return marking;
}

/// The subsystems of which some transition can fire in some marking that can be reached, whatever conditions
/// and times say. all: how many it can be at most. nullopt: too many markings to look at.
[[nodiscard]] std::optional<std::set<std::uint32_t>> who_can_go_on(const FlatNet& net, const Marking& from,
                                                                   std::size_t all) {
  std::set<std::uint32_t> able;
  std::unordered_set<Marking> seen{from};
  std::deque<Marking> open{from};
  constexpr std::size_t most = 5000;
  while (!open.empty() && able.size() < all) {
    if (seen.size() > most) return std::nullopt;
    const Marking marking = std::move(open.front());
    open.pop_front();
    for (const FlatNet::FlatTransition& transition : net.transitions) {
      const auto marked = [&](std::uint32_t place) { return marking[place]; };
      if (!std::ranges::all_of(transition.inputs, marked)) continue;
      if (transition.instance != system_instance) able.insert(transition.instance);
      Marking next = marking;
      for (const std::uint32_t place : transition.inputs) next[place] = false;
      for (const std::uint32_t place : transition.outputs) next[place] = true;
      if (seen.insert(next).second) open.push_back(std::move(next));
    }
  }
  return able;
}

/// A system of two to four subsystems with blocking channels, some of which end.
void build(TestSystem& system, std::mt19937_64& random) {
  const auto below = [&](std::uint64_t limit) { return random() % limit; };
  const auto script = [&] { return for_iterations(below(2) == 0 ? 0 : 1 + below(8)); };
  auto path = [count = 0]() mutable { return "robot.s" + std::to_string(count++); };
  const auto rate = [&] { return Duration(std::chrono::milliseconds(3 + below(20))); };
  if (below(3) == 0) {  // relays in a line or a circle, one of which may be another sender
    const std::size_t size = 2 + below(2);
    const bool circle = below(2) == 0;
    std::vector<std::uint32_t> all;
    if (!circle) all.push_back(system.add(path(), nets::b_sender, script(), rate()));
    for (std::size_t at = 0; at < size; ++at) all.push_back(system.add(path(), relay, script(), rate()));
    if (!circle) all.push_back(system.add(path(), nets::b_receiver_ack, script(), rate()));
    for (std::size_t at = 0; at + 1 < all.size(); ++at)
      system.connect(all[at], at == 0 && !circle ? "x" : "y", all[at + 1], "x", acknowledged);
    if (circle) system.connect(all.back(), "y", all.front(), "x", acknowledged);
    return;
  }
  for (std::uint64_t pair = 0; pair < 1 + below(2); ++pair) {
    if (below(2) == 0) {
      const auto from = system.add(path(), below(2) == 0 ? leaver : nets::nb_sender, script(), rate());
      const bool timed = below(3) == 0;
      const auto to = system.add(path(), timed ? nets::b_receiver_timed : nets::b_receiver, script(), rate());
      system.connect(from, "x", to, "x", buffered, 0s, timed ? 5ms : 0s);
    } else {
      const bool timed = below(3) == 0;
      const auto from = system.add(path(), timed ? nets::b_sender_timed : nets::b_sender, script(), rate());
      const auto to =
          system.add(path(), below(3) == 0 ? nets::nb_receiver_ack : nets::b_receiver_ack, script(), rate());
      system.connect(from, "x", to, "x", acknowledged, timed ? 5ms : 0s);
    }
  }
}

/// One that has ended has no token in a place of its own but `out`.
[[nodiscard]] bool has_ended(const FlatNet& net, const Marking& marking, const std::string& path) {
  for (std::size_t place = 0; place < net.places.size(); ++place) {
    const std::string& name = net.places[place].name;
    if (marking[place] && name.starts_with(path + '.') && name != path + ".out" &&
        name.find("->") == std::string::npos)
      return false;
  }
  return true;
}

/// TESSERA_STUCK_SYSTEMS: how many, in place of 100.
TEST(Stuck, NobodyIsNamedWhoCouldGoOnAndHardlyAnybodyIsForgotten) {
  const std::uint64_t count = from_environment("TESSERA_STUCK_SYSTEMS", share_of(100));
  std::uint64_t stuck = 0, forgotten = 0, judged = 0;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    TestSystem system;
    build(system, random);
    RunOptions options = simulated(Duration(std::chrono::milliseconds(5 + random() % 300)));
    options.seed = seed;
    options.interleave = random() % 2 == 0;
    options.recording = scratch_file("stuck.tessrec");
    const RunSummary summary = run(system, options);
    const FlatNet net = net_of(system.system());
    const Marking marking = final_marking(options.recording, net);
    std::vector<std::uint32_t> left;
    for (std::uint32_t instance = 0; instance < summary.subsystems.size(); ++instance)
      if (!has_ended(net, marking, summary.subsystems[instance].path)) left.push_back(instance);
    const std::optional<std::set<std::uint32_t>> able = who_can_go_on(net, marking, left.size());
    if (!able) continue;
    ++judged;
    for (const std::uint32_t instance : left) {
      const bool named = summary.ended.find(summary.subsystems[instance].path + " at ") != std::string::npos;
      EXPECT_FALSE(named && able->contains(instance)) << summary.ended;
      stuck += named ? 1 : 0;
      forgotten += !named && !able->contains(instance) ? 1 : 0;
    }
  }
  EXPECT_GT(judged, count / 2);
  EXPECT_GT(stuck, count / 10);
  // A peer that others would have to free first, in an order that only an exhaustive search finds.
  EXPECT_LE(forgotten, 1 + count / 50);
}

}  // namespace
}  // namespace tessera::testing
