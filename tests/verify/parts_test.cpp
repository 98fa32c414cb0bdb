// Views around a few subsystems prove what circuits do not, for docks with many robots.

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "proved.hpp"

namespace tessera::verify {
namespace {

/// A dock that hears one robot after the other, and lends itself. `if_free`: when it lends.
std::string dock_of(int robots, const std::string& if_free, const std::string& properties) {
  std::string inputs, outputs, values, behaviours, channels;
  for (int robot = 0; robot < robots; ++robot) {
    const std::string i = std::to_string(robot), next = std::to_string((robot + 1) % robots);
    const std::string comma = robot == 0 ? "" : ", ", at = "robot[" + i + "].control.";
    inputs += comma + "ask_" + i + ": bool, done_" + i + ": bool";
    outputs += comma + "grant_" + i + ": bool";
    values += ", r" + i;
    behaviours += "        hear_" + i + ": { send: [], receive: [ask_" + i +
                  "], terminal: true, next: [{ to: lend_" + i + ", when: in.ask_" + i + ".fresh" + if_free +
                  " }, hear_" + next + "] }\n" + "        lend_" + i + ": { send: [grant_" + i +
                  "], receive: [], sets: { lent_to: r" + i + " }, terminal: true, next: lent_" + i + " }\n" +
                  "        lent_" + i + ": { send: [], receive: [done_" + i + "], terminal: in.done_" + i +
                  ".fresh, next: { to: hear_" + next + ", sets: { lent_to: nobody } } }\n";
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
         inputs + " }\n      outputs: { " + outputs + " }\n      memory: { lent_to: { values: [nobody" +
         values + "] } }\n      behaviours:\n" + behaviours + "channels:\n" + channels + "properties:\n" +
         properties;
}

constexpr const char* wanted = R"(
  - { name: one charges, never: "robot[0].control.charge and robot[1].control.charge" }
  - { name: it is lent, always: "not robot[3].control.charge or dock.control.memory.lent_to == r3" }
  - { name: answered, leads_to: "robot[*].control.ask => robot[*].control.charge or robot[*].control.pause" }
  - { name: free again, always_reachable: dock.control.memory.lent_to == nobody }
  - { name: free after, leads_to: "dock.control.memory.lent_to == r2 => dock.control.memory.lent_to == nobody" }
)";

/// Four robots have too many markings for a search through all of them.
TEST(Parts, ProveADockOfFourRobots) {
  const Proved all = proved(dock_of(4, " && memory.lent_to == nobody", wanted), std::chrono::minutes(2));
  for (const char* name : {"one charges", "it is lent", "answered", "free again", "free after", "goes_on"}) {
    EXPECT_EQ(all[name].verdict, Verdict::holds) << name << ": " << all[name].why;
    EXPECT_EQ(all[name].method, "some subsystems, whatever the others do") << name;
  }
}

/// A robot that keeps the dock for ever: the dock waits for it.
TEST(Parts, ProveNothingOfADockThatIsKept) {
  std::string text = dock_of(3, " && memory.lent_to == nobody", wanted);
  const std::string leaves = "terminal: elapsed > 1 s, next: leave";
  text.replace(text.find(leaves), leaves.size(), "next: leave");
  text.erase(text.find("  - { name: it is lent"),
             text.find("  - { name: answered") - text.find("  - { name: it is lent"));
  const Proved all = proved(text, std::chrono::minutes(2));
  for (const char* name : {"free again", "free after", "goes_on"})
    EXPECT_EQ(all[name].verdict, Verdict::violated) << name << ": " << all[name].why;
  EXPECT_EQ(all["one charges"].verdict, Verdict::holds);
}

}  // namespace
}  // namespace tessera::verify
