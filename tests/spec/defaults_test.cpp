#include <gmock/gmock.h>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Subsystem& control(const Reading& reading) {
  return reading.model->definitions.front().subsystems.front();
}

const Behaviour& behaviour(const Reading& reading, const std::string& name) {
  for (const Behaviour& one : control(reading).behaviours)
    if (one.name == name) return one;
  ADD_FAILURE() << name;
  return control(reading).behaviours.front();
}

std::vector<std::string> names(const Numbered<BufferId, Field>& buffers,
                               const std::optional<std::vector<BufferId>>& list) {
  std::vector<std::string> names;
  for (const BufferId id : list.value_or(std::vector<BufferId>{})) names.push_back(buffers[id].name);
  return names;
}

/// "safe when error, follow, end": the entries of `next`, without those that are implied.
std::string route(const Reading& reading, const std::string& name) {
  std::string text;
  for (const Next& next : behaviour(reading, name).next) {
    if (next.implied) continue;
    text += (text.empty() ? "" : ", ") +
            (next.behaviour.valid() ? control(reading).behaviours[next.behaviour].name : "end");
    if (next.when.kind == When::Kind::error) text += " when error";
    if (next.when.kind == When::Kind::named_error) text += " when named";
    if (next.when.kind == When::Kind::terminal) text += " when terminal";
  }
  return text;
}

std::string with(const std::string& system, const std::string& agent, const std::string& subsystem,
                 const std::string& behaviours) {
  return "tessera: 1\nsystem: s\n" + system + "agents:\n  a:\n" + agent +
         "    control:\n      rate: 10 Hz\n      inputs: { i: bool, j: bool }\n      outputs: { x: bool, y: "
         "bool, z: "
         "bool }\n" +
         subsystem + "      behaviours:\n" + behaviours +
         "channels:\n  - a.control.x -> a.control.i\n  - a.control.y -> a.control.j\n";
}

const std::string flow =
    "        go: { terminal: in.i, next: safe }\n"
    "        ends: { terminal: in.i }\n"
    "        for_ever: {}\n"
    "        own: { next: { to: go, when: error } }\n"
    "        stops: { terminal: in.i, next: [{ to: end, when: error }, go] }\n"
    "        named: { error: { lost: in.i, jam: in.j }, terminal: in.i, next: [go, { to: own, when: lost }] "
    "}\n"
    "        safe: { terminal: true, next: go }\n";

TEST(OnError, LeadsTheFailuresThatNoEntryNames) {
  const Reading reading(with("", "", "      on_error: safe\n", flow));
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(route(reading, "go"), "safe when error, safe");
  EXPECT_EQ(route(reading, "ends"), "safe when error, end");
  EXPECT_EQ(route(reading, "for_ever"), "safe when error");
  EXPECT_EQ(route(reading, "own"), "go when error");
  EXPECT_EQ(route(reading, "stops"), "end when error, go");
  EXPECT_EQ(route(reading, "named"), "go, own when named, safe when error");
}

TEST(OnError, DoesNotLeadTheFailuresOfItsBehaviourToItself) {
  const Reading reading(with("", "", "      on_error: safe\n", flow));
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(route(reading, "safe"), "go");
  EXPECT_THAT(reading.codes(), testing::Not(HasSubstr("N330"))) << "nothing has changed for it";
}

TEST(OnError, IsThatOfTheNearestLevelThatSaysIt) {
  const std::string one = "        go: {}\n        safe: { terminal: true, next: go }\n        rest: {}\n";
  const auto leads = [&](const std::string& system, const std::string& agent, const std::string& own) {
    const Reading reading(with(system, agent, own, one));
    EXPECT_TRUE(reading.model) << reading.report();
    return reading.model ? route(reading, "go") : "";
  };
  EXPECT_EQ(leads("on_error: safe\n", "", ""), "safe when error");
  EXPECT_EQ(leads("on_error: safe\n", "    on_error: rest\n", ""), "rest when error");
  EXPECT_EQ(leads("on_error: safe\n", "    on_error: rest\n", "      on_error: stop\n"), "end");
  EXPECT_EQ(leads("on_error: rest\n", "    on_error: stop\n", ""), "end");
  EXPECT_EQ(leads("on_error: stop\n", "    on_error: stop\n", "      on_error: safe\n"), "safe when error");
}

TEST(OnError, OfTheTemplateHoldsForItsAgents) {
  const std::string text =
      "tessera: 1\nsystem: s\non_error: stop\ntemplates:\n  t:\n    on_error: safe\n    control: { rate: 10 "
      "Hz, "
      "behaviours: { go: {}, safe: { terminal: true, next: go } } }\nagents:\n  a: { use: t, count: 3 }\n";
  const Reading reading(text);
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(route(reading, "go"), "safe when error");
}

TEST(Lists, OfTheSubsystemHoldForBehavioursThatHaveNone) {
  const Reading reading(with("", "", "      send: [z, x]\n      receive: { first: [i] }\n",
                             "        none: {}\n"
                             "        plain: { send: [y], receive: [] }\n"
                             "        more: { send: [+y], receive: [+j] }\n"
                             "        fewer: { send: [-x], receive: [-i] }\n"
                             "        both: { send: [-z, +y], receive: [-i, +j] }\n"));
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_TRUE(control(reading).receive_first);
  const auto sent = [&](const std::string& name) {
    return names(control(reading).outputs, behaviour(reading, name).send);
  };
  const auto received = [&](const std::string& name) {
    return names(control(reading).inputs, behaviour(reading, name).receive);
  };
  EXPECT_THAT(sent("none"), ElementsAre("z", "x"));
  EXPECT_THAT(sent("plain"), ElementsAre("y"));
  EXPECT_THAT(sent("more"), ElementsAre("z", "x", "y"));
  EXPECT_THAT(sent("fewer"), ElementsAre("z"));
  EXPECT_THAT(sent("both"), ElementsAre("x", "y"));
  EXPECT_THAT(received("none"), ElementsAre("i"));
  EXPECT_THAT(received("plain"), ElementsAre());
  EXPECT_THAT(received("more"), ElementsAre("i", "j"));
  EXPECT_THAT(received("fewer"), ElementsAre());
  EXPECT_THAT(received("both"), ElementsAre("j"));
}

TEST(Lists, ChangeAllBuffersAsDeclaredIfTheSubsystemHasNone) {
  const Reading reading(
      with("", "", "      receive: first\n",
           "        all: { terminal: true, next: fewer }\n        fewer: { send: [-y], receive: [-i] }\n"));
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_FALSE(behaviour(reading, "all").send) << "all, in the order of the channels";
  EXPECT_THAT(names(control(reading).outputs, behaviour(reading, "fewer").send), ElementsAre("x", "z"));
  EXPECT_THAT(names(control(reading).inputs, behaviour(reading, "fewer").receive), ElementsAre("j"));
}

TEST(SharedConditions, AreThoseThatTheBehaviourWouldWriteItself) {
  const Reading reading(
      with("", "", "      conditions: { paused: in.i, late: elapsed > 2 s, no: false }\n",
           "        one: { terminal: paused, error: { late }, next: [{ to: two, when: paused }, { to: "
           "one, when: late }, end] }\n"
           "        two: { terminal: { paused, own: in.j, no }, next: one }\n"));
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(route(reading, "one"), "two when terminal, one when named, end");
  const Behaviour& two = behaviour(reading, "two");
  ASSERT_EQ(two.terminal.expressions.size(), 3U);
  EXPECT_EQ(two.terminal.expressions[ExpressionId{0}].name, "paused");
  EXPECT_EQ(two.terminal.expressions[ExpressionId{0}].text, "in.i");
  EXPECT_EQ(two.terminal.expressions[ExpressionId{0}].references.size(), 1U);
  EXPECT_EQ(two.terminal.expressions[ExpressionId{1}].text, "in.j");
  EXPECT_EQ(two.terminal.expressions[ExpressionId{2}].text, "false");
}

}  // namespace
}  // namespace tessera::spec
