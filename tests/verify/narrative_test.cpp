#include "verify/counterexample/narrative.hpp"

#include <gtest/gtest.h>

#include "faults.hpp"
#include "proved.hpp"
#include "verify/communication/abstraction.hpp"

namespace tessera::verify {
namespace {

/// The run of the fault's violation as lines: "4-7 b.control starts in go: computes (t1)".
std::vector<std::string> told(const char* name) {
  const Fault& given = fault(name);
  const Proved faulty = proved(given.faulty);
  const PropertyResult& bad = faulty[given.property];
  const net::Net net = abstract_net(faulty.net, bad.exceptions ? Assume::exceptions : Assume::conditions);
  std::vector<std::string> lines;
  for (const Act& act : narrate(net, bad.trace))
    lines.push_back(std::to_string(act.first) + "-" + std::to_string(act.last) + " " + act.who + " " +
                    act.text);
  return lines;
}

std::string line_of(const std::vector<std::string>& lines, const std::string& who) {
  std::string all;
  for (const std::string& line : lines)
    if (line.find(" " + who + " ") != std::string::npos) all += line.substr(line.find(who)) + "\n";
  return all;
}

TEST(Narrative, CountsEveryFiringOnce) {
  const Fault& given = fault("a ring that waits on itself");
  const Proved faulty = proved(given.faulty);
  const PropertyResult& bad = faulty[given.property];
  std::size_t next = 1;
  for (const Act& act : narrate(abstract_net(faulty.net), bad.trace)) {
    EXPECT_EQ(act.first, next);
    EXPECT_LE(act.first, act.last);
    next = act.last + 1;
  }
  EXPECT_EQ(next, bad.trace.size() + 1);
}

TEST(Narrative, TellsBothSidesOfABlockingChannel) {
  const std::vector<std::string> lines = told("a producer that outwaits a dead consumer");
  EXPECT_EQ(lines.front(), "1-3  the system starts, agents a, b start");
  EXPECT_NE(line_of(lines, "a.control").find("sends y (t1, t2), waits for the acknowledgement"),
            std::string::npos)
      << line_of(lines, "a.control");
  EXPECT_NE(line_of(lines, "b.control").find("is terminal (t5), ends (t_go_1)"), std::string::npos)
      << line_of(lines, "b.control");
}

TEST(Narrative, NamesTheBehaviourThatASubsystemGoesOnTo) {
  const std::string consumer = line_of(told("a consumer that forgets to acknowledge"), "b.control");
  EXPECT_NE(consumer.find("starts in first: computes (t1"), std::string::npos) << consumer;
  EXPECT_NE(consumer.find("goes on to rest"), std::string::npos) << consumer;
}

TEST(Narrative, TellsOfAChoiceThatNobodyMade) {
  const std::string consumer = line_of(told("no initial condition may hold"), "b.control");
  EXPECT_NE(consumer.find("none of its initial conditions holds"), std::string::npos) << consumer;
}

/// The reasons are in words of the specification, and no transition is named. In the drawing, a transition has the name
/// without the facts that it reads.
TEST(Narrative, TellsInPlainWordsWhyABehaviourFollows) {
  const Proved faulty = proved(R"(tessera: 1
system: s
agents:
  a:
    control:
      rate: 10 Hz
      inputs: { g: bool }
      behaviours:
        ask: { terminal: true, next: [{ to: rest, when: in.g.fresh }, ask] }
        rest: { terminal: elapsed > 1 s, next: end }
  b: { control: { rate: 10 Hz, outputs: { g: bool }, behaviours: { tell: {} } } }
channels: [{ from: b.control.g, to: a.control.g, receive: blocking, timeout: 1 s }]
properties: [{ name: still, never: a.control.rest }]
)");
  const PropertyResult& bad = faulty["still"];
  ASSERT_EQ(bad.verdict, Verdict::violated);
  const net::Net net = abstract_net(faulty.net);
  const auto last = [&](Wording wording) { return narrate(net, bad.trace, wording).back().text; };
  EXPECT_EQ(last(Wording::plain),
            "starts in ask: computes, receives g, is done, goes on to rest because in.g.fresh");
  EXPECT_EQ(
      last(Wording::with_transitions),
      "starts in ask: computes (t1, t1, t2, t3), receives g (t1, t2), is terminal (t5), goes on to rest");
}

TEST(Narrative, TellsOfTimeouts) {
  std::string all;
  for (const std::string& line : told("a request that is taken back")) all += line + "\n";
  EXPECT_NE(all.find("waits for y until its timeout"), std::string::npos) << all;
}

}  // namespace
}  // namespace tessera::verify
