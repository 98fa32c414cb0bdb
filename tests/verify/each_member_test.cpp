// A specification that is written once for each member of a fleet means the same as written out.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "proved.hpp"

namespace tessera::verify {
namespace {

constexpr const char* carriers = R"(
tessera: 1
system: depot
templates:
  carrier:
    control:
      rate: 10 Hz
      inputs: { grant: bool }
      outputs: { request: bool, done: bool }
      behaviours:
        ask: { terminal: in.grant.fresh, send: [request], next: at_dock }
        at_dock: { terminal: elapsed > 1 s, send: [], receive: [], next: leave }
        leave: { terminal: true, send: [done], receive: [], next: ask }
agents:
  robot: { use: carrier, count: COUNT }
)";

constexpr const char* written_once = R"(
  dock:
    control:
      rate: 10 Hz
      inputs: { request: "bool[each robot]", done: "bool[each robot]" }
      outputs: { grant: "bool[each robot]" }
      memory: { lent_to: { values: [nobody, each robot] } }
      behaviours:
        wait:
          terminal: any(in.request.fresh)
          send: []
          receive: [request]
          next: [{ to: "lend[i]", when: "in.request[i].fresh && memory.lent_to == nobody" }, wait]
        lend:
          for: each robot
          sets: { lent_to: "robot[i]" }
          terminal: true
          send: ["grant[i]"]
          receive: []
          next: "lent[i]"
        lent:
          for: each robot
          terminal: "in.done[i].fresh"
          send: []
          receive: ["done[i]"]
          next: { to: wait, sets: { lent_to: nobody } }
channels:
  - { from: "robot[i].control.request", to: "dock.control.request[i]", receive: blocking, timeout: 100 ms }
  - { from: "robot[i].control.done", to: "dock.control.done[i]", receive: blocking, timeout: 100 ms }
  - { from: "dock.control.grant[i]", to: "robot[i].control.grant", receive: blocking, timeout: 100 ms }
)";

/// The same for two robots, as it was written before.
constexpr const char* written_out = R"(
  dock:
    control:
      rate: 10 Hz
      inputs: { request_0: bool, request_1: bool, done_0: bool, done_1: bool }
      outputs: { grant_0: bool, grant_1: bool }
      memory: { lent_to: { values: [nobody, robot_0, robot_1] } }
      behaviours:
        wait:
          terminal: in.request_0.fresh || in.request_1.fresh
          send: []
          receive: [request_0, request_1]
          next:
            - { to: lend_0, when: in.request_0.fresh && memory.lent_to == nobody }
            - { to: lend_1, when: in.request_1.fresh && memory.lent_to == nobody }
            - wait
        lend_0: { sets: { lent_to: robot_0 }, terminal: true, send: [grant_0], receive: [], next: lent_0 }
        lend_1: { sets: { lent_to: robot_1 }, terminal: true, send: [grant_1], receive: [], next: lent_1 }
        lent_0:
          { terminal: in.done_0.fresh, send: [], receive: [done_0], next: { to: wait, sets: { lent_to: nobody } } }
        lent_1:
          { terminal: in.done_1.fresh, send: [], receive: [done_1], next: { to: wait, sets: { lent_to: nobody } } }
channels:
  - { from: "robot[0].control.request", to: dock.control.request_0, receive: blocking, timeout: 100 ms }
  - { from: "robot[1].control.request", to: dock.control.request_1, receive: blocking, timeout: 100 ms }
  - { from: "robot[0].control.done", to: dock.control.done_0, receive: blocking, timeout: 100 ms }
  - { from: "robot[1].control.done", to: dock.control.done_1, receive: blocking, timeout: 100 ms }
  - { from: dock.control.grant_0, to: "robot[0].control.grant", receive: blocking, timeout: 100 ms }
  - { from: dock.control.grant_1, to: "robot[1].control.grant", receive: blocking, timeout: 100 ms }
)";

std::string depot(const std::string& count, const std::string& dock) {
  std::string text = carriers;
  text.replace(text.find("COUNT"), 5, count);
  return text + dock;
}

/// "lend[0]" and "lend_0" become the same name.
std::string plain(std::string name) {
  std::ranges::replace(name, '[', '_');
  std::erase(name, ']');
  return name;
}

std::vector<std::string> places_of(const net::Net& net) {
  std::vector<std::string> all;
  for (const net::Place& place : net.places())
    all.push_back(plain(place.name) + " " + std::to_string(place.tokens));
  std::ranges::sort(all);
  return all;
}

/// "name: inputs -> outputs, truth of its condition", so that two nets can be compared.
std::vector<std::string> transitions_of(const net::Net& net) {
  std::vector<std::string> all;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    std::string text = plain(net[id].name);
    for (const auto& arcs : {net.preset(id), net.postset(id)}) {
      std::vector<std::string> ends;
      for (const net::Arc& arc : arcs) ends.push_back(plain(net[arc.place].name));
      std::ranges::sort(ends);
      text += " :";
      for (const std::string& end : ends) text += " " + end;
    }
    all.push_back(text + " " + std::to_string(static_cast<int>(net[id].condition.truth)));
  }
  std::ranges::sort(all);
  return all;
}

TEST(EachMember, GivesTheNetOfTheSameWrittenOut) {
  const net::Net once = flattened(depot("2", written_once)), out = flattened(depot("2", written_out));
  EXPECT_EQ(places_of(once), places_of(out));
  EXPECT_EQ(transitions_of(once), transitions_of(out));
}

/// Asks one after the other. `next[i]`: where poll[i] leads; member 2 is the last.
std::string polling(const std::string& behaviours, bool ring) {
  std::string text = depot("3", R"(
  dock:
    control:
      rate: 10 Hz
      inputs: { request: "bool[each robot]", done: "bool[each robot]" }
      outputs: { grant: "bool[each robot]" }
      send: []
      receive: []
      behaviours:
)" + behaviours + R"(
channels:
  - { from: "robot[i].control.request", to: "dock.control.request[i]", receive: blocking, timeout: 100 ms }
  - { from: "robot[i].control.done", to: "dock.control.done[i]", receive: blocking, timeout: 100 ms }
  - { from: "dock.control.grant[i]", to: "robot[i].control.grant", receive: blocking, timeout: 100 ms }
)");
  if (ring) text.insert(text.find("count: 3") + 8, ", ring: true");
  return text;
}

/// "poll[0] -> poll[1]": where the behaviours `poll` of the dock lead.
std::vector<std::string> leads(const std::string& text) {
  const net::Net net = flattened(text);
  const auto behaviour = [](const net::Net& all, net::PlaceId place) {
    const std::string name = all[place].name.substr(std::string("dock.control.").size());
    return name.substr(0, name.find('.'));
  };
  std::vector<std::string> found;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    if (net[id].role != Step::leave || !net[id].name.starts_with("dock")) continue;
    const std::string from = behaviour(net, net.preset(id).front().place);
    const std::string to = behaviour(net, net.postset(id).front().place);
    if (from.starts_with("poll") && to != "out") found.push_back(from + " -> " + to);  // out: a failure
  }
  std::ranges::sort(found);
  return found;
}

TEST(EachMember, LeadsToItsNeighbour) {
  const std::string poll =
      "        poll: { for: each robot, receive: [\"request[i]\"], terminal: true, next: ";
  const std::vector<std::string> round{"poll[0] -> poll[1]", "poll[1] -> poll[2]", "poll[2] -> poll[0]"};
  EXPECT_EQ(leads(polling(poll + R"("poll[i+1]" })", /*ring=*/true)), round);
  EXPECT_EQ(leads(polling(poll + R"(["poll[i+1]", "poll[0]"] })", /*ring=*/false)), round);
  // Backwards, and farther than the fleet is long.
  EXPECT_EQ(leads(polling(poll + R"("poll[i - 5]" })", /*ring=*/true)), round);
  EXPECT_EQ(leads(polling(poll + R"(["poll[i-2]", "poll[i+1]", "poll[0]"] })", /*ring=*/false)), round);
  // Once through the fleet, then something else.
  const std::string rest = "        rest: { terminal: true, next: \"poll[0]\" }\n";
  EXPECT_EQ(leads(polling(rest + poll + R"(["poll[i+1]", rest] })", /*ring=*/false)),
            (std::vector<std::string>{"poll[0] -> poll[1]", "poll[1] -> poll[2]", "poll[2] -> rest"}));
}

TEST(EachMember, IsKnownToProofs) {
  const std::vector<std::string> names{"one at the dock", "lent to its robot", "some is lent", "safe"};
  for (const char* count : {"1", "2"}) {
    const Proved all = proved(depot(count, std::string(written_once) + R"yaml(
properties:
  - { name: one at the dock, never: "robot[i].control.at_dock and dock.control.memory.lent_to != robot[i]" }
  - { name: lent to its robot, never: "dock.control.lent[i] and dock.control.memory.lent_to != robot[i]" }
  - { name: some is lent, reachable: "any(dock.control.lent[*])" }
)yaml"),
                              std::chrono::seconds(60), names);
    for (const std::string& name : names)
      EXPECT_EQ(all[name].verdict, Verdict::holds) << count << ' ' << name << ": " << all[name].why;
  }
}

}  // namespace
}  // namespace tessera::verify
