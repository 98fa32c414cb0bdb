// Conditions that ask how the last communication of a buffer ended are answers of the net, not free choices.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "net/token_game.hpp"
#include "proved.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/communication/free_net.hpp"

namespace tessera::verify {
namespace {

/// Two clients, to which a server lends in turn. `enter` is the condition for entering.
std::string lock(const std::string& enter,
                 const std::string& receive = "receive: blocking, timeout: 200 ms") {
  return R"(tessera: 1
system: lock
templates:
  client:
    control:
      rate: 20 Hz
      inputs: { grant: bool }
      outputs: { done: bool }
      memory: { tired: bool }
      behaviours:
        ask:    { send: [], receive: [grant], terminal: true, next: [{ to: inside, when: ")" +
         enter + R"(" }, pause] }
        pause:  { send: [], receive: [], terminal: elapsed > 100 ms, next: ask }
        inside: { send: [], receive: [], terminal: elapsed > 300 ms, next: leave }
        leave:  { send: [done], receive: [], terminal: true, next: pause }
agents:
  a: { use: client }
  b: { use: client }
  server:
    control:
      rate: 20 Hz
      inputs: { done_a: bool, done_b: bool }
      outputs: { grant_a: bool, grant_b: bool }
      behaviours:
        lend_a: { send: [grant_a], receive: [done_a], terminal: true, next: lend_b }
        lend_b: { send: [grant_b], receive: [done_b], terminal: true, next: lend_a }
channels:
  - { from: server.control.grant_a, to: a.control.grant, )" +
         receive + R"( }
  - { from: server.control.grant_b, to: b.control.grant, )" +
         receive + R"( }
  - { from: a.control.done, to: server.control.done_a, receive: blocking }
  - { from: b.control.done, to: server.control.done_b, receive: blocking }
properties:
  - { name: one at a time, never: a.control.inside and b.control.inside }
  - { name: each enters, always_reachable: b.control.inside }
)";
}

TEST(KnownFacts, NobodyEntersTheFieldProjectWithoutAGrant) {
  const char* data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const std::filesystem::path file =
      std::filesystem::path(data) / "field/projects/timeout_is_free_choice/spec.yaml";
  ASSERT_TRUE(std::filesystem::exists(file)) << file;
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const char* name = "nobody enters without a grant";
  EXPECT_EQ(proved(text, std::chrono::seconds(60), {name})[name].verdict, Verdict::holds);
}

TEST(KnownFacts, ATimedGrantExcludesUnlessTheClientEntersWithoutIt) {
  struct Case {
    const char* enter;
    Verdict one_at_a_time;
  };
  for (const auto& [enter, expected] : std::vector<Case>{
           {"in.grant.fresh", Verdict::holds},
           {"in.grant.fresh && !memory.tired", Verdict::holds},
           {"not (in.grant.timed_out)", Verdict::holds},
           {"!(in.grant.timed_out || memory.tired)", Verdict::holds},
           {"in.grant.fresh || memory.tired", Verdict::violated},
           {"in.grant.timed_out", Verdict::violated},
           {"in.grant.fresh == memory.tired", Verdict::violated},  // is not understood: a free choice
           {"memory.tired", Verdict::violated},
       }) {
    const Proved lent =
        proved(lock(enter), std::chrono::seconds(60), {"one at a time", "safe", "each enters"});
    EXPECT_EQ(lent["one at a time"].verdict, expected) << enter;
    EXPECT_EQ(lent["safe"].verdict, Verdict::holds) << enter;
    // A client that takes a grant and does not enter never gives it back.
    const bool gives_back =
        expected == Verdict::holds && std::string(enter).find("tired") == std::string::npos;
    if (expected == Verdict::holds) {
      EXPECT_EQ(lent["each enters"].verdict, gives_back ? Verdict::holds : Verdict::violated) << enter;
    }
    if (expected != Verdict::violated) continue;
    const net::Net net = abstract_net(lent.net);
    net::Marking marking = net::initial_marking(net);
    EXPECT_TRUE(net::fire_all(net, lent["one at a time"].trace, marking)) << enter;
  }
}

TEST(KnownFacts, TheNetDoesNotKnowWhatNoSideWaitsFor) {
  const Proved lent = proved(lock("in.grant.fresh", "receive: non_blocking"));
  EXPECT_EQ(lent["one at a time"].verdict, Verdict::violated);
  EXPECT_TRUE(lent.net.parts().facts.empty());
}

/// The names of the transitions of the client that touch the places of its fact.
TEST(KnownFacts, TheNetOfAClientHasEachEndOfItsReceiveTwiceAndEntriesForTheAnswersThatTheyFit) {
  const net::Net net = flattened(lock("in.grant.fresh"));
  std::set<std::string> found;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    if (!net[id].name.starts_with("a.")) continue;
    std::string text = net[id].name.substr(2);
    bool touches = false;
    for (const auto& [arcs, mark] : {std::pair(net.preset(id), " -"), {net.postset(id), " +"}})
      for (const net::Arc& arc : arcs)
        if (net[arc.place].fact.valid()) {
          touches = true;
          text += mark + net[arc.place].name.substr(std::string("a.control.").size());
        }
    if (touches) found.insert(text);
  }
  const std::set<std::string> expected{
      "control.ask.rcv.grant.t2.grant.came -grant.came +grant.came",
      "control.ask.rcv.grant.t2.grant.missed -grant.missed +grant.came",
      "control.ask.rcv.grant.timeout.grant.came -grant.came +grant.missed",
      "control.ask.rcv.grant.timeout.grant.missed -grant.missed +grant.missed",
      "control.t_ask_1.grant.came -grant.came +grant.came",
      "control.t_ask_2.grant.came -grant.came +grant.came",  // only after a failure of the server
      "control.t_ask_2.grant.missed -grant.missed +grant.missed",
      "control.t_ask_3.grant.came -grant.came +grant.came",  // the end after a failure
      "control.t_ask_3.grant.missed -grant.missed +grant.missed",
  };
  EXPECT_EQ(found, expected);
  for (const net::Transition& transition : net.transitions())
    if (transition.name == "a.control.t_ask_2.grant.came") {
      EXPECT_EQ(transition.condition.truth, net::Condition::Truth::never);
      EXPECT_EQ(transition.condition.known(true).truth, net::Condition::Truth::free);
    }
}

/// A behaviour ends in one place, by t5 or t6. The questions of the ending decide which entry can follow.
TEST(KnownFacts, AnEntryFollowsOnlyAnEndingThatIsPossibleWithTheKnownValues) {
  struct Case {
    const char *behaviour, *property;
  };
  for (const auto& [behaviour, property] : std::vector<Case>{
           {"{ terminal: true, error: memory.m == v, next: [{ to: c, when: error }, b] }", "never c"},
           {"{ terminal: true, error: { f: memory.m == v }, next: [{ to: c, when: f }, b] }", "never c"},
           {"{ terminal: memory.m == v, error: memory.m == u, next: [{ to: b, when: error }, c] }",
            "never c"},
           {"{ terminal: memory.m == v, next: [{ to: b, when: error }, c] }", "never c"},
           {"{ terminal: memory.m == v, next: [{ to: b, when: error }, { to: b, when: elapsed > 1 s }] }",
            "survives_exceptions"}}) {
    const Proved all = proved(std::string(R"(tessera: 1
system: endings
agents:
  a:
    control:
      rate: 20 Hz
      memory: { m: { values: [u, v] } }
      behaviours:
        b: )") + behaviour + R"(
        c: { next: { to: c, when: error } }
properties:
  - { name: never c, never: a.control.c }
)");
    EXPECT_EQ(all[property].verdict, Verdict::holds) << behaviour;
  }
}

TEST(KnownFacts, TheFreeNetIsTheNetOfASpecificationThatAsksNothing) {
  const net::Net asks = flattened(lock("in.grant.fresh")), free = flattened(lock("memory.tired"));
  const std::optional<FreeNet> without = free_net(asks, {});
  ASSERT_TRUE(without);
  EXPECT_FALSE(free_net(free, {}));
  const auto ends = [](const net::Net& net) {
    std::multiset<std::string> all;
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
      std::string text;
      for (const auto& arcs : {net.preset({index}), net.postset({index})}) {
        for (const net::Arc& arc : arcs) text += net[arc.place].name + ' ';
        text += '>';
      }
      all.insert(text);
    }
    return all;
  };
  EXPECT_EQ(ends(without->net), ends(free));
  EXPECT_EQ(without->net.places().size(), free.places().size());
}

}  // namespace
}  // namespace tessera::verify
