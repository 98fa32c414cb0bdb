// A dock whose memory is part of the net: it is lent to one robot at a time.

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "net/token_game.hpp"
#include "proved.hpp"

namespace tessera::verify {
namespace {

/// A dock that is lent to one of two robots. `b_if`: when it is lent to b, if b has asked.
std::string lending_dock(const std::string& b_if, const std::string& properties) {
  std::string text = R"(
tessera: 1
system: lending
templates:
  robot:
    control:
      rate: 10 Hz
      inputs: { grant: bool }
      outputs: { ask: bool, done: bool }
      behaviours:
        ask: { send: [ask], terminal: in.grant.fresh, next: work }
        work: { send: [], receive: [], terminal: elapsed > 1 s, next: back }
        back: { send: [done], receive: [], terminal: true, next: ask }
agents:
  a: { use: robot }
  b: { use: robot }
  dock:
    control:
      rate: 10 Hz
      inputs: { ask_a: bool, ask_b: bool, done_a: bool, done_b: bool }
      outputs: { grant_a: bool, grant_b: bool }
      memory: { lent_to: { values: [nobody, a, b] }, served: { counts: 0..2 } }
      behaviours:
        wait:
          send: []
          terminal: true
          next:
            - { to: wait, when: in.done_a.fresh && memory.lent_to == a, sets: { lent_to: nobody } }
            - { to: wait, when: in.done_b.fresh && b == memory.lent_to, sets: { lent_to: nobody } }
            - { to: lend_a, when: in.ask_a.fresh && memory.lent_to == nobody, sets: { served: +1 } }
            - { to: lend_b, when: in.ask_b.fresh && B_IF, sets: { served: +1 } }
            - { to: wait, when: memory.served == 2, sets: { served: 0 } }
            - wait
        lend_a: { send: [grant_a], receive: [], sets: { lent_to: a }, terminal: true, next: wait }
        lend_b: { send: [grant_b], receive: [], sets: { lent_to: b }, terminal: true, next: wait }
channels:
  - { from: a.control.ask, to: dock.control.ask_a, receive: blocking, timeout: 100 ms }
  - { from: b.control.ask, to: dock.control.ask_b, receive: blocking, timeout: 100 ms }
  - { from: a.control.done, to: dock.control.done_a, receive: blocking, timeout: 100 ms }
  - { from: b.control.done, to: dock.control.done_b, receive: blocking, timeout: 100 ms }
  - { from: dock.control.grant_a, to: a.control.grant, receive: blocking, timeout: 100 ms }
  - { from: dock.control.grant_b, to: b.control.grant, receive: blocking, timeout: 100 ms }
properties:
)";
  text.replace(text.find("B_IF"), 4, b_if);
  return text + properties;
}

TEST(Lending, ProvesThatADockIsLentToOne) {
  const std::vector<std::string> names{"one works", "lent to a", "it is served", "it is free again", "safe"};
  const Proved all = proved(lending_dock("memory.lent_to == nobody", R"(
  - { name: one works, never: a.control.work and b.control.work }
  - { name: lent to a, always: "not a.control.work or dock.control.memory.lent_to == a" }
  - { name: it is served, reachable: dock.control.memory.served >= 2 }
  - { name: it is free again, always_reachable: dock.control.memory.lent_to == nobody }
)"),
                            std::chrono::seconds(60), names);
  for (const std::string& name : names)
    EXPECT_EQ(all[name].verdict, Verdict::holds) << name << ": " << all[name].why;
}

TEST(Lending, ShowsTheRunOfAMistake) {
  const Proved all =
      proved(lending_dock("memory.lent_to != b",
                          "  - { name: one works, never: a.control.work and b.control.work }\n"),
             std::chrono::seconds(60), {"one works"});
  const PropertyResult& mistake = all["one works"];
  ASSERT_EQ(mistake.verdict, Verdict::violated) << mistake.why;
  ASSERT_TRUE(mistake.has_trace);
  std::vector<std::string> leaves;
  for (const net::TransitionId id : mistake.trace)
    if (all.net[id].role == Step::leave && all.net[id].name.starts_with("dock"))
      leaves.push_back(all.net[id].name);
  EXPECT_FALSE(leaves.empty());
  // The run is one of the net: what memory holds decides, step by step.
  net::Marking marking = net::initial_marking(all.net);
  EXPECT_TRUE(net::fire_all(all.net, mistake.trace, marking));
}

TEST(Lending, RefusesPropertiesThatAskNoValue) {
  struct Case {
    const char *property, *says;
  };
  for (const Case& one :
       {Case{"dock.control.memory.lent_to == c", "E261: unknown value 'c'"},
        {"dock.control.memory.lent_to < a", "E263: 'memory.lent_to' has values without an order"},
        {"dock.control.memory.lent_to", "E112: 'memory.lent_to' is one of nobody, a, b: which?"},
        {"dock.control.memory.lent == a", "hint: did you mean 'lent_to'?"},
        {"dock.control.memory.served > 2", "E264: 'memory.served' never fits this"},
        {"dock.control.memory.served >= 0", "E264: 'memory.served' always fits this"},
        {"dock.control.wait == a", "E114: only a memory cell is compared"}}) {
    std::string report;
    try {
      static_cast<void>(flattened(
          lending_dock("memory.lent_to == nobody", std::string("  - { never: ") + one.property + " }\n")));
    } catch (const std::runtime_error& refused) {
      report = refused.what();
    }
    EXPECT_NE(report.find(one.says), std::string::npos) << one.property << '\n' << report.substr(0, 400);
  }
}

}  // namespace
}  // namespace tessera::verify
