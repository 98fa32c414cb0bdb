// A group of behaviours that is written once and used in several places means the same as written out.

#include <gtest/gtest.h>

#include <string>

#include "proved.hpp"
#include "verify/hashes.hpp"

namespace tessera::verify {
namespace {

std::string robot_with(const std::string& templates, const std::string& behaviours) {
  return R"(
tessera: 1
system: depot
templates:
)" + templates +
         R"(  dock:
    control:
      rate: 10 Hz
      inputs: { ask: bool }
      outputs: { grant: bool }
      behaviours: { lend: { terminal: in.ask.fresh, next: lend } }
agents:
  left: { use: dock }
  right: { use: dock }
  robot:
    control:
      rate: 10 Hz
      inputs: { grant_left: bool, grant_right: bool }
      outputs: { ask_left: bool, ask_right: bool }
      memory: { at: { values: [nowhere, west, east] }, low: bool }
      parameters: { lease: 90 s }
      behaviours:
        work: { terminal: memory.low, send: [], receive: [], next: charge_left }
)" + behaviours +
         R"(channels:
  - { from: robot.control.ask_left, to: left.control.ask, receive: blocking, timeout: 1 s }
  - { from: robot.control.ask_right, to: right.control.ask, receive: blocking, timeout: 1 s }
  - { from: left.control.grant, to: robot.control.grant_left, receive: blocking, timeout: 1 s }
  - { from: right.control.grant, to: robot.control.grant_right, receive: blocking, timeout: 1 s }
)";
}

constexpr const char* docking_templates = R"(  docking:
    with: [ask, grant, side, lease]
    until: memory.low
    behaviours:
      wait: { use: waiting, with: { ask: ask, grant: grant }, next: dock }
      dock:
        send: []
        receive: []
        terminal: elapsed > lease && memory.low
        next: [{ to: end, when: memory.at == side, sets: { at: nowhere } }, { to: end, sets: { at: side } }]
  waiting:
    with: [ask, grant]
    behaviours:
      call: { send: { ask: { when: memory.low } }, receive: [grant], terminal: true, next: end }
)";

constexpr const char* two_uses = R"(
        charge_left:
          use: docking
          with: { ask: ask_left, grant: grant_left, side: west, lease: parameters.lease }
          next: [{ to: charge_right, when: until }, work]
        charge_right:
          use: docking
          until: "!memory.low"
          with: { ask: ask_right, grant: grant_right, side: east, lease: 20 s }
          next: work
)";

constexpr const char* groups_written_out = R"(
        charge_left:
          until: memory.low
          next: [{ to: charge_right, when: until }, work]
          behaviours:
            wait:
              next: dock
              behaviours:
                call:
                  { send: { ask_left: { when: memory.low } }, receive: [grant_left], terminal: true, next: end }
            dock:
              send: []
              receive: []
              terminal: elapsed > parameters.lease && memory.low
              next: [{ to: end, when: memory.at == west, sets: { at: nowhere } }, { to: end, sets: { at: west } }]
        charge_right:
          until: "!memory.low"
          next: work
          behaviours:
            wait:
              next: dock
              behaviours:
                call:
                  { send: { ask_right: { when: memory.low } }, receive: [grant_right], terminal: true, next: end }
            dock:
              send: []
              receive: []
              terminal: elapsed > 20 s && memory.low
              next: [{ to: end, when: memory.at == east, sets: { at: nowhere } }, { to: end, sets: { at: east } }]
)";

TEST(GroupTemplates, GiveTheNetOfTheSameWrittenOut) {
  EXPECT_EQ(hash_of(flattened(robot_with(docking_templates, two_uses))),
            hash_of(flattened(robot_with("", groups_written_out))));
}

TEST(GroupTemplates, AreKnownToProofs) {
  const Proved all = proved(robot_with(docking_templates, std::string(two_uses)) + R"yaml(properties:
  - { name: entered, reachable: "robot.control.charge_right.wait.call" }
  - { name: one at a time, never: "robot.control.charge_left and robot.control.charge_right" }
)yaml");
  for (const char* name : {"entered", "one at a time", "safe"})
    EXPECT_EQ(all[name].verdict, Verdict::holds) << name << ": " << all[name].why;
}

}  // namespace
}  // namespace tessera::verify
