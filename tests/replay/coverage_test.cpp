#include "replay/coverage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "layers/models.hpp"
#include "random_run.hpp"

namespace tessera::replay {
namespace {

using Missing = Coverage::Missing;
using Names = std::set<std::string>;

Names missing_in(const Coverage& coverage, Missing::Kind kind) {
  Names names;
  for (const Coverage::Group& group : coverage.groups)
    for (const Missing& missing : group.missing)
      if (missing.kind == kind) names.insert(missing.name);
  return names;
}

Coverage coverage_of_runs(const test::Built& built, const std::vector<Recording>& runs) {
  FiringCounts counts(built.net);
  for (const Recording& run : runs) EXPECT_FALSE(counts.add(run));
  return coverage_of(built.pages, built.net, counts);
}

/// A run that fires these transitions, whether or not they could fire.
Recording run_of(const net::Net& net, const Names& names) {
  Recording recording;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    recording.transitions.push_back({net.transitions()[index].name, system_instance});
    if (!names.contains(net.transitions()[index].name)) continue;
    Event event{.subject = index,
                .origin = system_instance << 8 | static_cast<std::uint32_t>(Event::Kind::firing)};
    recording.entries.push_back({event, {}});
  }
  EXPECT_EQ(recording.entries.size(), names.size());
  return recording;
}

// The token game of random_run records the marked places; Coverage derives them from the firings.
TEST(Coverage, OfRandomRunsIsWhatTheTokenGameReached) {
  Random random(7);
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const test::Built built = test::build(test::random_model(seed));
    const net::Net& net = built.net;
    const Recording run = random_run(net, 5 + seed * 3, random);
    Names marked, fired;
    for (const net::Place& place : net.places())
      if (place.tokens > 0) marked.insert(place.name);
    for (const Recording::Entry& entry : run.entries) {
      fired.insert(net.transitions()[entry.event.subject].name);
      for (const net::Arc& arc : net.postset(net::TransitionId{entry.event.subject}))
        marked.insert(net[arc.place].name);
    }
    const Coverage coverage = coverage_of_runs(built, {run});
    EXPECT_EQ(coverage.places.reached, marked.size()) << seed << ": what is left out was marked";
    EXPECT_EQ(coverage.transitions.reached, fired.size()) << seed << ": what is left out has fired";
    EXPECT_EQ(coverage.places.all + coverage.transitions.all + coverage.unreachable,
              net.places().size() + net.transitions().size());
    for (const std::string& name : missing_in(coverage, Missing::Kind::place))
      EXPECT_FALSE(marked.contains(name));
    for (const std::string& name : missing_in(coverage, Missing::Kind::transition))
      EXPECT_FALSE(fired.contains(name));
    for (const std::string& name : missing_in(coverage, Missing::Kind::holds))
      EXPECT_FALSE(fired.contains(name));
  }
}

TEST(Coverage, OfNoRunIsNothing) {
  const test::Built built = test::build(test::line_follower());
  const Coverage coverage = coverage_of_runs(built, {});
  EXPECT_EQ(coverage.places.reached + coverage.transitions.reached + coverage.conditions.reached +
                coverage.behaviours.reached,
            0u);
  EXPECT_GT(coverage.conditions.all, 0u);
  EXPECT_EQ(coverage.runs, 0u);
}

TEST(Coverage, OfRunsIsTheSumOfTheirs) {
  Random random(11);
  const test::Built built = test::build(test::random_model(12));
  std::vector<Recording> runs;
  std::size_t before = 0;
  for (int count = 0; count < 5; ++count) {
    runs.push_back(random_run(built.net, 40, random));
    const Coverage coverage = coverage_of_runs(built, runs);
    EXPECT_GE(coverage.transitions.reached, before);
    EXPECT_GE(coverage.transitions.reached, coverage_of_runs(built, {runs.back()}).transitions.reached);
    EXPECT_EQ(coverage.runs, runs.size());
    before = coverage.transitions.reached;
  }
}

TEST(Coverage, AConditionIsFalseWhenAnotherTransitionFiresInstead) {
  const test::Built built = test::build(test::line_follower());
  const std::string follow = "robot.control.follow";
  Names holds, does_not;
  for (const net::Transition& transition : built.net.transitions())
    if (transition.condition.kind == net::Condition::Kind::error) holds.insert(transition.name);
  ASSERT_TRUE(holds.contains(follow + ".t6"));
  const Coverage nothing = coverage_of_runs(built, {run_of(built.net, {})});
  EXPECT_TRUE(missing_in(nothing, Missing::Kind::holds).contains(follow + ".t6"));
  EXPECT_TRUE(missing_in(nothing, Missing::Kind::does_not_hold).contains(follow + ".t6"));

  const Coverage gone_on = coverage_of_runs(built, {run_of(built.net, {follow + ".t4"})});
  EXPECT_TRUE(missing_in(gone_on, Missing::Kind::holds).contains(follow + ".t6"));
  EXPECT_FALSE(missing_in(gone_on, Missing::Kind::does_not_hold).contains(follow + ".t6"));

  const Coverage failed = coverage_of_runs(built, {run_of(built.net, {follow + ".t6"})});
  EXPECT_FALSE(missing_in(failed, Missing::Kind::holds).contains(follow + ".t6"));
  EXPECT_TRUE(missing_in(failed, Missing::Kind::does_not_hold).contains(follow + ".t6"));
  EXPECT_EQ(failed.conditions.all, nothing.conditions.all);
  EXPECT_EQ(failed.conditions.reached, 1u);
}

/// A net of one place with a choice between entries of `next`, as the layers draw it.
TEST(Coverage, AnEntryOfNextIsFalseOnlyWhenALaterOneIsTaken) {
  net::HierarchicalNet pages;
  pages.pages.emplace_back();
  net::Net net;
  const net::PlaceId from = net.add(net::Place{.name = "from", .tokens = 1}),
                     to = net.add(net::Place{.name = "to"});
  for (std::uint32_t entry = 0; entry < 3; ++entry) {
    net::Condition condition{.kind = net::Condition::Kind::next, .truth = net::Condition::Truth::free};
    condition.entry = entry;
    const net::Arc in{from}, out{to};
    net.add(net::Transition{.name = "entry" + std::to_string(entry), .condition = condition}, {&in, 1},
            {&out, 1});
  }
  const auto never_false = [&](const Names& fired) {
    return missing_in(coverage_of_runs({pages, net}, {run_of(net, fired)}), Missing::Kind::does_not_hold);
  };
  EXPECT_EQ(never_false({"entry0"}), (Names{"entry0", "entry1"}))
      << "behind the last there is nothing to take";
  EXPECT_EQ(never_false({"entry1"}), (Names{"entry1"}));
  EXPECT_EQ(never_false({"entry2"}), (Names{}));
}

TEST(Coverage, ABehaviourIsReachedWhenItsInputIsMarked) {
  const test::Built built = test::build(test::line_follower());
  const auto reached = [&](const Names& fired) {
    Names paths;
    for (const Coverage::Group& group : coverage_of_runs(built, {run_of(built.net, fired)}).groups)
      if (group.kind == Coverage::Group::Kind::behaviour && group.reached) paths.insert(group.path);
    return paths;
  };
  EXPECT_TRUE(reached({}).empty());
  EXPECT_EQ(reached({"robot.control.t_in"}).size(), 1u);
  EXPECT_TRUE(reached({"robot.t_in"}).empty());
}

TEST(Coverage, CountsOfSchedulesAreAddedToThoseOfRecordings) {
  const test::Built built = test::build(test::line_follower());
  FiringCounts counts(built.net);
  EXPECT_FALSE(counts.add(run_of(built.net, {"t_in"})));
  EXPECT_FALSE(counts.add({{"t_in", 20}, {"robot.t_in", 20}}, 20));
  EXPECT_TRUE(counts.add({{"t_in", 1}, {"robot.t_inn", 1}}, 1));
  EXPECT_EQ(counts.runs(), 21u);
  const nlohmann::json json =
      nlohmann::json::parse(coverage_json(coverage_of(built.pages, built.net, counts), built.net, counts));
  EXPECT_EQ(json.at("firings").at("t_in"), 21) << "a refused count adds nothing";
  EXPECT_EQ(json.at("runs"), 21);
  EXPECT_EQ(json.at("transitions").at("reached"), 2);
}

TEST(Coverage, OfARecordingOfAnotherNetIsRefused) {
  const test::Built built = test::build(test::line_follower());
  FiringCounts counts(built.net);
  Recording other;
  other.transitions.push_back({"robot.arm.t_in", 0});
  EXPECT_EQ(counts.add(other).value().text, "the net has no transition 'robot.arm.t_in'");
  EXPECT_EQ(counts.runs(), 0u);
}

TEST(Coverage, OfASegmentHasTheMarkingItBeginsWithAndSaysThatEventsAreMissing) {
  const test::Built built = test::build(test::line_follower());
  Recording segment;
  segment.segment = 3;
  Event marking{.origin = system_instance << 8 | static_cast<std::uint32_t>(Event::Kind::marking)};
  segment.entries.push_back({marking, "robot.control.follow.in\nrobot.motor.drive.in"});
  const Coverage coverage = coverage_of_runs(built, {segment});
  EXPECT_TRUE(coverage.lacks_events);
  EXPECT_FALSE(missing_in(coverage, Missing::Kind::place).contains("robot.control.follow.in"));
  EXPECT_EQ(coverage.behaviours.reached, 2u);
  EXPECT_NE(coverage_text(coverage, "spec.yaml", built.net.parts().sources).find("events are missing"),
            std::string::npos);
}

TEST(Coverage, TextNamesABehaviourThatWasNotEnteredOnceAndSharesInPercent) {
  const test::Built built = test::build(test::line_follower());
  const std::string text = coverage_text(coverage_of_runs(built, {run_of(built.net, {"t_in"})}), "spec.yaml",
                                         built.net.parts().sources);
  EXPECT_TRUE(text.starts_with("coverage of the net by 1 run:\n")) << text;
  EXPECT_NE(text.find("robot.control.follow\n    never entered\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("follow.t1"), std::string::npos) << text;
}

TEST(Coverage, NamesTheLinesOfIncludedFilesWithTheirFiles) {
  diagnostics::Sources sources;
  sources.add("spec.yaml", "parts/robot.yaml", 2);
  Coverage coverage;
  Coverage::Group& group = coverage.groups.emplace_back();
  group.kind = Coverage::Group::Kind::subsystem;
  group.path = "robot.control";
  group.span = {2, 1, 1};
  Coverage::Missing& missing = group.missing.emplace_back();
  missing.kind = Missing::Kind::place;
  missing.name = "robot.control.in";
  missing.span = {5, 1, 1};
  const std::string text = coverage_text(coverage, "robots/spec.yaml", sources);
  EXPECT_NE(text.find("robot.control   robots/spec.yaml:2\n"), std::string::npos) << text;
  EXPECT_NE(text.find("in   robots/parts/robot.yaml:3\n"), std::string::npos) << text;
}

TEST(Coverage, OfALargeFleetIsCut) {
  const test::Built built = test::build(test::fleet(100));
  const std::string text = coverage_text(coverage_of_runs(built, {}), "spec.yaml", built.net.parts().sources);
  EXPECT_LT(std::ranges::count(text, '\n'), 1000);
  EXPECT_NE(text.find("more, which --coverage=FILE has"), std::string::npos);
}

}  // namespace
}  // namespace tessera::replay
