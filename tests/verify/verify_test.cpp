#include "verify/verify.hpp"

#include <gmock/gmock.h>

#include "layers/layers.hpp"
#include "layers/models.hpp"
#include "net/flatten.hpp"

namespace tessera::verify {
namespace {

using net::Arc;
using net::Invariant;
using net::PlaceId;
using testing::HasSubstr;

std::vector<Arc> to(std::initializer_list<std::uint32_t> places) {
  std::vector<Arc> arcs;
  for (const std::uint32_t place : places) arcs.push_back({PlaceId{place}, 1});
  return arcs;
}

net::Place place(const char* name, std::uint32_t tokens = 0) {
  net::Place made;
  made.name = name;
  made.tokens = tokens;
  return made;
}

net::Transition transition(const char* name) {
  net::Transition made;
  made.name = name;
  return made;
}

/// a -> b -> a.
net::Net ring() {
  net::Net net;
  net.add(place("a", 1));
  net.add(place("b"));
  net.add(transition("there"), to({0}), to({1}));
  net.add(transition("back"), to({1}), to({0}));
  return net;
}

Invariant sum(std::string name, std::vector<Invariant::Term> terms, std::int64_t total) {
  return {std::move(name), std::move(terms), total};
}

const Invariant one_of_ring{"one of a, b", {{PlaceId{0}, 1}, {PlaceId{1}, 1}}, 1};

TEST(Check, HoldsForACoveredRing) {
  const Report report = check(ring(), {one_of_ring});
  ASSERT_EQ(report.properties.size(), 1U);
  EXPECT_EQ(report.properties[0].name, "safe");
  EXPECT_EQ(report.properties[0].verdict, Verdict::holds);
  EXPECT_EQ(report.properties[0].method, "place invariants");
  EXPECT_EQ(report.properties[0].why, "");
}

TEST(Check, NamesThePlaceThatNothingBounds) {
  net::Net net = ring();
  net.add(place("loose"));
  const Report report = check(net, {one_of_ring});
  EXPECT_EQ(report.properties[0].verdict, Verdict::unknown);
  EXPECT_EQ(report.properties[0].why, "no invariant bounds place 'loose'");
}

TEST(Check, NamesTheTransitionThatBreaksAnInvariant) {
  net::Net net = ring();
  net.add(transition("double"), to({0}), to({0, 1}));
  const Report report = check(net, {one_of_ring});
  EXPECT_EQ(report.properties[0].verdict, Verdict::unknown);
  EXPECT_EQ(report.properties[0].why, "transition 'double' changes invariant 'one of a, b' by 1");
}

TEST(Check, NamesTheInvariantThatStartsWrong) {
  Invariant wrong = one_of_ring;
  wrong.total = 0;
  EXPECT_EQ(check(ring(), {wrong}).properties[0].why, "invariant 'one of a, b' starts with 1, not with 0");
}

TEST(Check, CountsTheWeightsOfArcs) {
  net::Net net;
  net.add(place("a", 1));
  net.add(place("b"));
  net.add(transition("t"), to({0}), std::vector<Arc>{{PlaceId{1}, 2}});
  EXPECT_THAT(check(net, {one_of_ring}).properties[0].why, HasSubstr("transition 't' changes invariant"));
}

TEST(Check, DoesNotTakeATotalOfTwoForABound) {
  net::Net net;
  net.add(place("a", 2));
  net.add(place("b"));
  net.add(transition("there"), to({0}), to({1}));
  const Report report = check(net, {sum("two", {{PlaceId{0}, 1}, {PlaceId{1}, 1}}, 2)});
  EXPECT_EQ(report.properties[0].why, "no invariant bounds place 'a'; no invariant bounds place 'b'");
}

// c is only ever marked with b: c = b.
net::Net shadowed_ring() {
  net::Net net;
  net.add(place("a", 1));
  net.add(place("b"));
  net.add(place("c"));
  net.add(transition("there"), to({0}), to({1, 2}));
  net.add(transition("back"), to({1, 2}), to({0}));
  return net;
}

TEST(Check, BoundsThePositivePlacesOfASignedInvariantByTheNegative) {
  const Invariant equal = sum("c as b", {{PlaceId{2}, 1}, {PlaceId{1}, -1}}, 0);
  EXPECT_EQ(check(shadowed_ring(), {one_of_ring, equal}).properties[0].verdict, Verdict::holds);
  EXPECT_EQ(check(shadowed_ring(), {equal, one_of_ring}).properties[0].verdict, Verdict::holds)
      << "in whatever order they come";
  EXPECT_EQ(check(shadowed_ring(), {equal}).properties[0].verdict, Verdict::unknown) << "nothing bounds b";
}

// Two rings that do not know of each other, and a place that counts both: it can hold two tokens.
TEST(Check, DoesNotBoundBySeveralUnitInvariants) {
  net::Net net;
  for (const char* name : {"a", "b", "c", "d", "sum"})
    net.add(place(name, std::string_view(name) == "a" || std::string_view(name) == "c" ? 1 : 0));
  net.add(transition("ab"), to({0}), to({1, 4}));
  net.add(transition("cd"), to({2}), to({3, 4}));
  const std::vector<Invariant> invariants{
      sum("ab", {{PlaceId{0}, 1}, {PlaceId{1}, 1}}, 1), sum("cd", {{PlaceId{2}, 1}, {PlaceId{3}, 1}}, 1),
      sum("both", {{PlaceId{4}, 1}, {PlaceId{1}, -1}, {PlaceId{3}, -1}}, 0)};
  EXPECT_EQ(check(net, invariants).properties[0].why, "no invariant bounds place 'sum'");
}

// u and v each shadow b, and sum = u + v = 2 b: replacing both by b would count b twice.
TEST(Check, DoesNotCountAPlaceTwiceWhenItStandsForTwo) {
  net::Net net;
  for (const char* name : {"a", "b", "u", "v", "sum"})
    net.add(place(name, std::string_view(name) == "a" ? 1 : 0));
  net.add(transition("there"), to({0}),
          std::vector<Arc>{{PlaceId{1}, 1}, {PlaceId{2}, 1}, {PlaceId{3}, 1}, {PlaceId{4}, 2}});
  const std::vector<Invariant> invariants{
      one_of_ring, sum("u as b", {{PlaceId{2}, 1}, {PlaceId{1}, -1}}, 0),
      sum("v as b", {{PlaceId{3}, 1}, {PlaceId{1}, -1}}, 0),
      sum("sum", {{PlaceId{4}, 1}, {PlaceId{2}, -1}, {PlaceId{3}, -1}}, 0)};
  EXPECT_EQ(check(net, invariants).properties[0].why, "no invariant bounds place 'sum'");
}

TEST(Check, SaysHowManyMistakesItLeavesOut) {
  net::Net net;
  for (const char* name : {"p", "q", "r", "s", "t"}) net.add(place(name));
  EXPECT_THAT(check(net, {}).properties[0].why, HasSubstr("'r'; and 2 more"));
}

struct Broken {
  const char* name;
  void (*spoil)(net::HierarchicalNet&);
  const char* culprit;
};

net::Page& page(net::HierarchicalNet& net, const char* path) { return net.pages[net.find(path).value]; }

// The line follower drawn wrongly: the layers' own invariants find it out.
const std::vector<Broken> broken_drawings{
    {"an agent forks twice",
     [](net::HierarchicalNet& net) { page(net, "robot").transitions[0].outputs.push_back(4); },
     "'robot.t_in'"},
    {"a write keeps the memory",
     [](net::HierarchicalNet& net) { page(net, "robot.control.init.snd").transitions[2].outputs.pop_back(); },
     "'robot.control.init.snd.motion.t2'"},
    {"a read takes nothing",
     [](net::HierarchicalNet& net) { page(net, "robot.motor.drive.rcv").transitions[0].inputs.pop_back(); },
     "'robot.motor.drive.rcv.velocity.t1'"},
    {"a subsystem starts twice",
     [](net::HierarchicalNet& net) { page(net, "robot.sensor").nodes[0].tokens = 1; },
     "'one token in robot.sensor' starts with 2"},
};

TEST(Check, FindsOutAWrongDrawing) {
  const spec::Model model = test::line_follower();
  for (const Broken& broken : broken_drawings) {
    SCOPED_TRACE(broken.name);
    diagnostics::Diagnostics out("m", "");
    net::HierarchicalNet pages = test::build(model).pages;
    broken.spoil(pages);
    const std::optional<net::Net> flat = net::flatten(pages, out);
    ASSERT_TRUE(flat);
    const Report report = check(*flat, layers::invariants(model, pages, *flat));
    EXPECT_EQ(report.properties[0].verdict, Verdict::unknown);
    EXPECT_THAT(report.properties[0].why, HasSubstr(broken.culprit));
    EXPECT_FALSE(accept(*flat, report));
  }
}

TEST(Accept, KeepsTheNetAndItsReport) {
  const std::optional<VerifiedNet> verified = accept(ring(), check(ring(), {one_of_ring}));
  ASSERT_TRUE(verified);
  EXPECT_EQ(verified->net().places().size(), 2U);
  EXPECT_TRUE(verified->report().all_hold());
}

TEST(Accept, TakesWhatFailsOnlyWhenTheFailureIsNamed) {
  const auto with = [](Verdict verdict, bool warning = false) {
    Report report;
    report.properties.push_back({"goes_on", verdict});
    report.properties.back().warning = warning;
    return report;
  };
  EXPECT_FALSE(accept(ring(), {}));
  EXPECT_FALSE(accept(ring(), with(Verdict::unknown)));
  EXPECT_TRUE(accept(ring(), with(Verdict::unknown), {.unknown = true}));
  EXPECT_FALSE(accept(ring(), with(Verdict::violated), {.unknown = true}));
  EXPECT_TRUE(accept(ring(), with(Verdict::violated), {.violated = true}));
  EXPECT_TRUE(accept(ring(), with(Verdict::violated, /*warning=*/true)));
}

TEST(Hash, IsThatOfTheNet) {
  const Report report = check(ring(), {one_of_ring});
  EXPECT_EQ(report.net_hash.size(), 32U);
  EXPECT_EQ(report.net_hash, check(ring(), {}).net_hash);
  net::Net other = ring();
  other.add(place("c"));
  EXPECT_NE(report.net_hash, check(other, {}).net_hash);
}

TEST(Hash, OfAVerificationChangesWithInvariantsAndConstants) {
  const Report report = check(ring(), {one_of_ring});
  EXPECT_NE(report.verification_hash, check(ring(), {}).verification_hash);
  net::Net net;
  net.add(place("a", 1));
  net.add(place("b"));
  net::Transition there = transition("there");
  there.condition.truth = net::Condition::Truth::free;
  net.add(there, to({0}), to({1}));
  net.add(transition("back"), to({1}), to({0}));
  const Report freed = check(net, {one_of_ring});
  EXPECT_EQ(freed.net_hash, report.net_hash);
  EXPECT_NE(freed.verification_hash, report.verification_hash);
}

}  // namespace
}  // namespace tessera::verify
