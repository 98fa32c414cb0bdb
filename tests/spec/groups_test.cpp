#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "spec/model/endings.hpp"
#include "spec/model/successors.hpp"
#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

using ::testing::ElementsAre;

constexpr const char* nested = R"(tessera: 1
system: groups
agents:
  robot:
    control:
      rate: 20 Hz
      memory: { pause: bool, stuck: bool }
      on_error: safe
      behaviours:
        charge:
          until: memory.pause
          behaviours:
            fetch:
              on_error: again
              behaviours:
                ask: { terminal: memory.stuck, next: end }
                again: { error: memory.stuck, terminal: true, next: ask }
            dock: { terminal: true }
          next: [{ to: rest, when: until }, charge]
        rest: { terminal: true, next: charge }
        safe: {}
)";

class Groups : public ::testing::Test {
 protected:
  const Reading reading_{nested};
  [[nodiscard]] const Subsystem& control() const {
    return reading_.model->definitions.front().subsystems.front();
  }
  [[nodiscard]] BehaviourId id(const std::string& name) const {
    for (const BehaviourId one : control().behaviours.ids())
      if (control().behaviours[one].name == name) return one;
    ADD_FAILURE() << name;
    return {0};
  }
  /// "again when error": the entries of `next`.
  [[nodiscard]] std::vector<std::string> routes(const std::string& name) const {
    std::vector<std::string> all;
    for (const Next& entry : control().behaviours[id(name)].next) {
      std::string text =
          entry.behaviour.valid() ? control().behaviours[entry.behaviour].name : std::string("end");
      if (entry.when.kind == When::Kind::error) text += " when error";
      if (entry.when.kind == When::Kind::terminal) text += " when until";
      all.push_back(text);
    }
    return all;
  }
  [[nodiscard]] std::vector<std::string> successors_of(const std::string& name) const {
    std::vector<std::string> all;
    for (const BehaviourId one : successors(control(), id(name)))
      all.push_back(control().behaviours[one].name);
    return all;
  }
};

TEST_F(Groups, StandBeforeWhatIsInThem) {
  ASSERT_TRUE(reading_.model);
  std::vector<std::string> names;
  for (const Behaviour& one : control().behaviours) names.push_back(one.name);
  EXPECT_THAT(names, ElementsAre("charge", "charge.fetch", "charge.fetch.ask", "charge.fetch.again",
                                 "charge.dock", "rest", "safe"));
  EXPECT_EQ(control().behaviours[id("charge.fetch.ask")].parent, id("charge.fetch"));
  EXPECT_EQ(control().behaviours[id("charge.fetch.ask")].identifier(), "charge_fetch_ask");
  EXPECT_EQ(control().behaviours[id("charge")].group->start, id("charge.fetch"));
}

TEST_F(Groups, LeadFailuresByTheirOnErrorOrOut) {
  ASSERT_TRUE(reading_.model);
  EXPECT_THAT(routes("charge.fetch.ask"),
              ElementsAre("charge.fetch.again when error", "end when until", "end"));
  EXPECT_THAT(routes("charge.fetch.again"),
              ElementsAre("end when error", "end when until", "charge.fetch.ask"));
  EXPECT_THAT(routes("charge.fetch"), ElementsAre("end when error", "end when until", "end"));
  EXPECT_THAT(routes("charge"), ElementsAre("safe when error", "rest when until", "charge"));
}

TEST_F(Groups, LeadOnWhereTheyAreLeft) {
  ASSERT_TRUE(reading_.model);
  EXPECT_THAT(successors_of("charge"), ElementsAre("charge.fetch"));
  EXPECT_THAT(successors_of("charge.dock"), ElementsAre("safe", "rest", "charge"));
}

/// The condition is that of the group; the group itself remembers what its behaviours have found.
TEST_F(Groups, AskUntilInEachBehaviour) {
  ASSERT_TRUE(reading_.model);
  for (const char* name : {"charge.fetch.ask", "charge.fetch.again", "charge.dock"}) {
    const Expression& until = control().behaviours[id(name)].terminal.expressions.back();
    EXPECT_EQ(until.text, "memory.pause") << name;
    EXPECT_EQ(until.until_of, id("charge")) << name;
  }
  EXPECT_EQ(control().behaviours[id("charge")].terminal.expressions.front().text, "");
}

/// A group two deep whose behaviours take all failures, by entries of their own or by `on_error` of their group.
constexpr const char* caught = R"(tessera: 1
system: groups
agents:
  robot:
    control:
      rate: 20 Hz
      memory: { pause: bool, stuck: bool }
      on_error: safe
      behaviours:
        charge:
          until: memory.pause
          behaviours:
            fetch:
              on_error: again
              behaviours:
                ask: { terminal: memory.stuck, next: end }
                again: { error: memory.stuck, terminal: true, next: [{ to: again, when: error }, ask] }
            dock: { terminal: true, next: [{ to: fetch, when: error }, end] }
          next: [{ to: rest, when: until }, charge]
        turn:
          behaviours:
            left: { next: { to: left, when: error } }
        rest: { terminal: true, next: turn }
        safe: {}
)";

class CaughtFailures : public Groups {
 protected:
  [[nodiscard]] static bool may_fail(const std::string& text, const std::string& name) {
    const Reading reading(text);
    if (!reading.model) return ADD_FAILURE() << reading.report(), true;
    const Subsystem& control = reading.model->definitions.front().subsystems.front();
    for (const Behaviour& one : control.behaviours)
      if (one.name == name) return Endings(one).possible(Ending::failure);
    return ADD_FAILURE() << name, true;
  }
  [[nodiscard]] static std::string with(const std::string& from, const std::string& to) {
    std::string text = caught;
    text.replace(text.find(from), from.size(), to);
    return text;
  }
};

TEST_F(CaughtFailures, LeaveNoGroup) {
  EXPECT_FALSE(may_fail(caught, "charge.fetch"));
  EXPECT_FALSE(may_fail(caught, "charge"));
  EXPECT_FALSE(may_fail(caught, "turn"));  // it never ends at all
  EXPECT_TRUE(may_fail(caught, "charge.dock"));
}

TEST_F(CaughtFailures, LeaveAGroupIfOneBehaviourLetsThemOut) {
  const std::string inner = with("[{ to: again, when: error }, ask]", "ask");
  EXPECT_TRUE(may_fail(inner, "charge.fetch"));
  EXPECT_TRUE(may_fail(inner, "charge"));
  const std::string outer = with("[{ to: fetch, when: error }, end]", "end");
  EXPECT_FALSE(may_fail(outer, "charge.fetch"));
  EXPECT_TRUE(may_fail(outer, "charge"));
  EXPECT_TRUE(may_fail(with("on_error: again", "start: ask"), "charge.fetch"));
  // A group around them may take those that leave the inner one.
  std::string around = inner;
  around.insert(around.find("on_error: again"), "next: [{ to: dock, when: error }, dock]\n              ");
  EXPECT_TRUE(may_fail(around, "charge.fetch"));
  EXPECT_FALSE(may_fail(around, "charge"));
}

}  // namespace
}  // namespace tessera::spec
