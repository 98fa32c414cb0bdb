// Some subsystems, whatever the others do, prove what circuits do not: docks with many robots.

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "proved.hpp"

namespace tessera::verify {
namespace {

/// A dock that hears one robot after the other, and lends itself. `if_free`: when it lends.
std::string dock_of(int robots, const std::string& if_free, const std::string& properties) {
  std::string inputs, outputs, behaviours, channels;
  for (int robot = 0; robot < robots; ++robot) {
    const std::string i = std::to_string(robot), next = std::to_string((robot + 1) % robots);
    const std::string comma = robot == 0 ? "" : ", ", at = "robot[" + i + "].control.";
    inputs += comma + "ask_" + i + ": bool, done_" + i + ": bool";
    outputs += comma + "grant_" + i + ": bool";
    behaviours += "        hear_" + i + ": { send: [], receive: [ask_" + i +
                  "], terminal: true, next: [{ to: lend_" + i + ", when: in.ask_" + i + ".fresh" + if_free +
                  " }, hear_" + next + "] }\n" + "        lend_" + i + ": { send: [grant_" + i +
                  "], receive: [], sets: { lent_to: \"robot[" + i + "]\" }, terminal: true, next: lent_" + i +
                  " }\n" + "        lent_" + i + ": { send: [], receive: [done_" + i +
                  "], terminal: in.done_" + i + ".fresh, next: { to: hear_" + next +
                  ", sets: { lent_to: nobody } } }\n";
    channels += "  - { from: \"" + at + "ask\", to: dock.control.ask_" + i +
                ", receive: blocking, timeout: 100 ms }\n" + "  - { from: \"" + at +
                "done\", to: dock.control.done_" + i + ", receive: blocking }\n" +
                "  - { from: dock.control.grant_" + i + ", to: \"" + at +
                "grant\", receive: blocking, timeout: 1 s }\n";
  }
  return R"(
tessera: 1
system: depot
templates:
  robot:
    control:
      rate: 10 Hz
      inputs: { grant: bool }
      outputs: { ask: bool, done: bool }
      behaviours:
        ask: { send: [ask], terminal: true, next: [{ to: charge, when: in.grant.fresh }, pause] }
        pause: { send: [], receive: [], terminal: elapsed > 1 s, next: ask }
        charge: { send: [], receive: [], terminal: elapsed > 1 s, next: leave }
        leave: { send: [done], receive: [], terminal: true, next: pause }
agents:
  robot: { use: robot, count: )" +
         std::to_string(robots) + R"( }
  dock:
    control:
      rate: 10 Hz
      inputs: { )" +
         inputs + " }\n      outputs: { " + outputs +
         " }\n      memory: { lent_to: { values: [nobody, each robot] } }\n      behaviours:\n" + behaviours +
         "channels:\n" + channels + "properties:\n" + properties;
}

constexpr const char* wanted = R"(
  - { name: one charges, never: "robot[0].control.charge and robot[1].control.charge" }
  - { name: it is lent, always: "not robot[1].control.charge or dock.control.memory.lent_to == robot[1]" }
  - { name: answered, leads_to: "robot[*].control.ask => robot[*].control.charge or robot[*].control.pause" }
  - { name: free after, leads_to: "dock.control.memory.lent_to == robot[1] => dock.control.memory.lent_to == nobody" }
  - { name: each is lent it, always: "not robot[*].control.charge or dock.control.memory.lent_to == robot[*]" }
)";

/// The verdict of parts alone.
Verdict said_by_parts(const std::string& text, const std::string& property) {
  return proved(text, std::chrono::minutes(2), {property}, "parts")[property].verdict;
}

/// All markings of such a dock are too many for a search.
TEST(Parts, ProveADockOfManyRobots) {
  const std::vector<std::string> names{"it is lent", "answered", "free after", "each is lent it", "goes_on"};
  const Proved all =
      proved(dock_of(8, " && memory.lent_to == nobody", wanted), std::chrono::minutes(2), names);
  for (const std::string& name : names) {
    EXPECT_EQ(all[name].verdict, Verdict::holds) << name << ": " << all[name].why;
    EXPECT_EQ(all[name].method, "search of parts") << name;
  }
}

/// The part that is searched for each of many robots is the same for all but those with which the dock begins, whatever their
/// number.
TEST(Parts, AreSearchedOnceForEqualMembers) {
  const auto markings = [](int robots) {
    const std::string text = dock_of(robots, " && memory.lent_to == nobody", wanted);
    const std::string name = "each is lent it";
    return proved(text, std::chrono::minutes(2), {name}, "parts")[name].states;
  };
  const std::uint64_t few = markings(6);
  EXPECT_GT(few, 0U);
  EXPECT_EQ(markings(12), few);
}

/// A robot that keeps the dock for ever, which waits for it; a dock that does not wait.
TEST(Parts, ProveNothingThatIsWrong) {
  std::string kept = dock_of(2, " && memory.lent_to == nobody", wanted);
  const std::string leaves = "terminal: elapsed > 1 s, next: leave";
  kept.replace(kept.find(leaves), leaves.size(), "next: leave");
  EXPECT_EQ(said_by_parts(kept, "it is lent"), Verdict::holds);
  EXPECT_EQ(said_by_parts(kept, "free after"), Verdict::unknown);
  std::string hasty = dock_of(2, " && memory.lent_to == nobody", wanted);
  const std::string waits = "receive: [done_1], terminal: in.done_1.fresh";
  hasty.replace(hasty.find(waits), waits.size(), "receive: [], terminal: true");
  EXPECT_EQ(said_by_parts(hasty, "it is lent"), Verdict::unknown);
}

}  // namespace
}  // namespace tessera::verify
