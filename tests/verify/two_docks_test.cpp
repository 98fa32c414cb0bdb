// Two docks of one template, each of which serves every member of a fleet: in one process, and in several.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "proved.hpp"

namespace tessera::verify {
namespace {

const std::string two_docks = R"(tessera: 1
system: docks
templates:
  dock:
    control:
      rate: 10 Hz
      inputs: { ask: "bool[each robot]", done: "bool[each robot]" }
      outputs: { grant: "bool[each robot]" }
      memory: { lent_to: { values: [nobody, each robot] } }
      behaviours:
        wait:
          send: []
          receive: [ask]
          terminal: any(in.ask.fresh)
          next: [{ to: "lend[i]", when: "in.ask[i].fresh" }, wait]
        lend:
          for: each robot
          sets: { lent_to: "robot[i]" }
          send: ["grant[i]"]
          receive: []
          terminal: true
          next: "lent[i]"
        lent:
          for: each robot
          send: []
          receive: ["done[i]"]
          terminal: "in.done[i].fresh"
          next: { to: wait, sets: { lent_to: nobody } }
  going:
    with: [ask, grant, done]
    behaviours:
      seek: { send: [ask], receive: [grant], terminal: in.grant.fresh, next: there }
      there: { send: [], receive: [], terminal: elapsed > 1 s, next: leave }
      leave: { send: [done], receive: [], terminal: true, next: end }
agents:
  robot:
    count: 2
    control:
      rate: 10 Hz
      inputs: { grant_near: bool, grant_far: bool }
      outputs: { ask_near: bool, done_near: bool, ask_far: bool, done_far: bool }
      behaviours:
        near: { use: going, with: { ask: ask_near, grant: grant_near, done: done_near }, next: far }
        far: { use: going, with: { ask: ask_far, grant: grant_far, done: done_far }, next: near }
  near: { use: dock }
  far: { use: dock }
channels:
  - { from: "robot[i].control.ask_near", to: "near.control.ask[i]", receive: blocking, timeout: 100 ms }
  - { from: "robot[i].control.done_near", to: "near.control.done[i]", receive: blocking, timeout: 100 ms }
  - { from: "near.control.grant[i]", to: "robot[i].control.grant_near", receive: blocking, timeout: 100 ms }
  - { from: "robot[i].control.ask_far", to: "far.control.ask[i]", receive: blocking, timeout: 100 ms }
  - { from: "robot[i].control.done_far", to: "far.control.done[i]", receive: blocking, timeout: 100 ms }
  - { from: "far.control.grant[i]", to: "robot[i].control.grant_far", receive: blocking, timeout: 100 ms }
)";

TEST(TwoDocks, OfOneTemplateHaveAMemoryOfTheirOwn) {
  const Proved all = proved(two_docks + R"(properties:
  - { name: lent to it, always: "not robot[0].control.near.there or near.control.memory.lent_to == robot[0]" }
  - { name: both work, reachable: "robot[0].control.near.there and robot[1].control.far.there" }
  - { name: one alone, always: "not robot[0].control.near.there or far.control.memory.lent_to == robot[0]" }
)",
                            std::chrono::seconds(60), {"lent to it", "both work", "one alone"});
  EXPECT_EQ(all["lent to it"].verdict, Verdict::holds) << all["lent to it"].why;
  EXPECT_EQ(all["both work"].verdict, Verdict::holds) << all["both work"].why;
  EXPECT_EQ(all["one alone"].verdict, Verdict::violated);
}

TEST(TwoDocks, ServeAFleetInAnotherProcess) {
  const Proved all =
      proved(two_docks + "deploy: { processes: { robots: \"robot[*]\", docks: [near, far] } }\n",
             std::chrono::seconds(60), {"safe", "deadlock_free", "survives_partition"});
  for (const char* name : {"safe", "deadlock_free", "survives_partition"})
    EXPECT_EQ(all[name].verdict, Verdict::holds) << name << ": " << all[name].why;
}

}  // namespace
}  // namespace tessera::verify
