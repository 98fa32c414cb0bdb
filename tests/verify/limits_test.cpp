#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

#include "explore/budget.hpp"
#include "explore/explore.hpp"
#include "families.hpp"
#include "faults.hpp"
#include "proved.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/counterexample/explanation.hpp"
#include "verify/counterexample/tidy_run.hpp"

// The output does not depend on the machine, and the work ends when it should.
namespace tessera::verify {
namespace {

/// So much that no machine is too slow.
constexpr std::chrono::seconds enough(200);

struct Family {
  const char* name;
  std::string (*text)(unsigned robots);
};

class Families : public testing::TestWithParam<Family> {};

TEST_P(Families, OfEightAreDecided) {
  const Proved all = proved(GetParam().text(8), enough);
  for (const PropertyResult& property : all.report.properties)
    EXPECT_NE(property.verdict, Verdict::unknown) << property.name << ": " << property.why;
}

INSTANTIATE_TEST_SUITE_P(AllBlocking, Families,
                         testing::Values(Family{"election", election}, Family{"philosophers", philosophers},
                                         Family{"docks", docks}, Family{"gossip", gossip},
                                         Family{"auction", auction}),
                         [](const auto& family) { return std::string(family.param.name); });

TEST(Limits, ADeadMarkingRefutesWhateverItShutsOut) {
  const Proved all = proved(
      philosophers(8) + "properties:\n  - { name: one eats again, always_reachable: p0.control.eat }\n",
      enough);
  for (const char* name : {"deadlock_free", "goes_on", "channels_flow", "one eats again"}) {
    SCOPED_TRACE(name);
    const PropertyResult& property = all[name];
    ASSERT_EQ(property.verdict, Verdict::violated);
    ASSERT_TRUE(property.has_trace);
    EXPECT_TRUE(explore::replay(explore::PtNet(abstract_net(all.net)), property.trace).has_value());
    EXPECT_EQ(property.cut_off, "");
  }
  EXPECT_EQ(all["live_behaviours"].verdict, Verdict::holds);
}

TEST(Limits, TwoCallsShowTheSameRuns) {
  for (const std::string& text : {gossip(4), credits(4), hub(4, true)}) {
    const Proved first = proved(text, enough), second = proved(text, enough);
    for (const PropertyResult& property : first.report.properties) {
      SCOPED_TRACE(property.name);
      const PropertyResult& again = second[property.name];
      EXPECT_EQ(property.verdict, again.verdict);
      EXPECT_EQ(property.method, again.method);
      EXPECT_EQ(property.trace, again.trace);
      EXPECT_EQ(texts_of(property), texts_of(again));
    }
  }
}

TEST(Limits, AFixedCycleOfBehavioursIsOneRound) {
  const Proved all = proved(server(30));
  for (const char* name : {"deadlock_free", "goes_on", "channels_flow"}) {
    EXPECT_EQ(all[name].verdict, Verdict::holds) << name;
    EXPECT_EQ(all[name].method, "circuits") << name;
  }
}

TEST(Limits, AStoppedVerificationSaysSo) {
  const net::Net net = flattened(gossip(4));
  const std::atomic<bool> stop{true};
  ProveOptions options;
  options.stop = &stop;
  const Report report = prove({net, nullptr, {}}, options);
  ASSERT_FALSE(report.properties.empty());
  for (const PropertyResult& property : report.properties) {
    EXPECT_EQ(property.verdict, Verdict::unknown);
    EXPECT_NE(property.why.find("it was interrupted"), std::string::npos) << property.why;
  }
}

TEST(Limits, WorkOnARunEndsWithItsBudget) {
  const Proved faulty = proved(fault("a ring that waits on itself").faulty);
  const net::Net net = abstract_net(faulty.net);
  const std::vector<net::TransitionId> run = faulty["goes_on"].trace;
  ASSERT_FALSE(run.empty());
  explore::Limits none;
  none.time = std::chrono::seconds(0);
  const explore::Budget spent(none);
  EXPECT_THROW(static_cast<void>(tidy(net, run, spent)), explore::CutOff);
  EXPECT_THROW(static_cast<void>(explained(net, run, spent)), explore::CutOff);
}

TEST(Limits, TheSearchForASecondTokenEndsAtTheFirst) {
  // Twenty switches: a million markings. One place holds two tokens from the start.
  net::Net net;
  net::Place two{.name = "two", .tokens = 2};
  const net::PlaceId start = net.add(two);
  for (int index = 0; index < 20; ++index) {
    const net::PlaceId off = net.add(net::Place{.name = "off" + std::to_string(index), .tokens = 1});
    const net::PlaceId on = net.add(net::Place{.name = "on" + std::to_string(index)});
    const std::vector<net::Arc> from{{off, 1}}, to{{on, 1}};
    net.add(net::Transition{.name = "up" + std::to_string(index)}, from, to);
    net.add(net::Transition{.name = "down" + std::to_string(index)}, to, from);
  }
  const std::vector<net::Arc> loop{{start, 1}};
  net.add(net::Transition{.name = "loop"}, loop, loop);
  ProveOptions options;
  options.only = {"safe"};
  const Report report = prove({net, nullptr, {}}, options);
  ASSERT_EQ(report.properties.size(), 1U);
  EXPECT_EQ(report.properties.front().verdict, Verdict::violated);
  EXPECT_TRUE(report.properties.front().trace.empty());
  EXPECT_LT(report.properties.front().states, 100U);
}

TEST(Stories, NameTheBehaviourThatKeepsAReaderFromBeingEntered) {
  const std::string text =
      "tessera: 1\n"
      "system: s\n"
      "types: { V: { v: float64 } }\n"
      "agents:\n"
      "  a:\n"
      "    control: { rate: 10 Hz, outputs: { y: V }, behaviours: { go: {} } }\n"
      "  b:\n"
      "    control:\n"
      "      rate: 10 Hz\n"
      "      inputs: { x: V }\n"
      "      behaviours:\n"
      "        look: { receive: [], next: take }\n"
      "        take: { receive: [x], terminal: true, next: look }\n"
      "channels:\n"
      "  - { from: a.control.y, to: b.control.x, send: blocking, receive: blocking }\n";
  const std::string cause =
      "b.control never leaves look (line 12), so take (line 13), which receives it, is never entered";
  const Proved all = proved(text);
  const PropertyResult& property = all["goes_on"];
  ASSERT_EQ(property.verdict, Verdict::violated);
  EXPECT_EQ(texts_of(property),
            (std::vector<std::string>{
                "a.control waits for the acknowledgement of a.control.y->b.control.x from b.control, and " +
                cause}));
  EXPECT_NE(property.why.find(cause), std::string::npos) << property.why;
  ASSERT_TRUE(property.has_trace);
  // b starts, and then does not matter: a is stuck whatever b does.
  const net::Net net = abstract_net(all.net);
  for (const net::TransitionId id : property.trace)
    if (net[id].subsystem.valid() && net[id].role != Step::start) {
      EXPECT_EQ(net.parts()[net[id].subsystem].path, "a.control");
    }
  EXPECT_EQ(
      texts_of(all["channels_flow"]),
      std::vector<std::string>{"b.control goes on and receives a.control.y->b.control.x no more: " + cause});
}

}  // namespace
}  // namespace tessera::verify
