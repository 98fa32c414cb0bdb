// The portfolio against exhaustive search, on small random systems.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "../environment.hpp"
#include "layers/layers.hpp"
#include "layers/models.hpp"
#include "oracle/nets/of_net.hpp"
#include "oracle/nets/reachability_graph.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/counterexample/waits.hpp"
#include "verify/verify.hpp"
#include "verify_circuits/naive_answers.hpp"
#include "verify_circuits/naive_endings.hpp"
#include "verify_circuits/random_system.hpp"

namespace tessera::verify {
namespace {

using oracle::Marking;
using oracle::ReachabilityGraph;

/// The long form of the test: TESSERA_RANDOM_SYSTEMS=20000.
bool any(const std::vector<bool>& flags) {
  return std::ranges::any_of(flags, [](bool flag) { return flag; });
}

/// The marking a run leads to; fails the test if it is none.
Marking end_of(const net::Net& net, const std::vector<net::TransitionId>& run) {
  const std::optional<Marking> end = oracle::replayed(net, run);
  EXPECT_TRUE(end) << "the run cannot be fired";
  return end.value_or(oracle::initial_marking(net));
}

net::Net starting_in(const net::Net& net, const Marking& tokens) {
  net::Net other(net.shared_parts());
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    net::Place place = net.places()[index];
    place.tokens = tokens[index];
    other.add(std::move(place));
  }
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    other.add(net.transitions()[index], net.preset({index}), net.postset({index}));
  return other;
}

/// The places that start a behaviour and are never marked, by the paths of the behaviours.
std::set<std::string> dead_behaviours(const net::Net& net) {
  const ReachabilityGraph graph(oracle::petri_net(net), 100000);
  std::vector<bool> marked(net.places().size(), false);
  for (ReachabilityGraph::State state = 0; state < graph.size(); ++state)
    for (std::size_t place = 0; place < marked.size(); ++place)
      if (graph.marking(state)[place] > 0) marked[place] = true;
  std::set<std::string> dead;
  for (std::size_t place = 0; place < marked.size(); ++place)
    if (const net::Place& one = net.places()[place];
        one.is(net::Layer::behaviour, net::PlaceRole::input) && !marked[place])
      dead.insert(one.name.substr(0, one.name.rfind('.')));
  return dead;
}

/// The results of an exhaustive search, with an abstraction of its own (naive_endings.hpp).
struct Truth {
  test::NaiveAnswers conditions;
  std::optional<test::NaiveAnswers> failures;  ///< if any iteration may fail; nullopt: too large
  /// Behaviours that never run, if nothing fails, and even then: the second only if `failures` are known.
  std::set<std::string> dead, dead_for_good;
};

constexpr std::size_t most_markings = 1500;

std::optional<Truth> truth_of(const spec::Model& model, const net::Net& flat) {
  const net::Net net = test::naively_abstract(model, flat, false);
  std::optional<test::NaiveAnswers> conditions = test::explore_naively(net, most_markings);
  if (!conditions) return std::nullopt;
  const net::Net failing = test::naively_abstract(model, flat, true);
  Truth truth{
      std::move(*conditions), test::explore_naively(failing, most_markings), dead_behaviours(net), {}};
  if (truth.failures) truth.dead_for_good = dead_behaviours(failing);
  return truth;
}

// ---------------------------------------------------------------------------------------------- runs

/// The transitions that can fire at some time from the initial marking; nullopt: there are too many markings.
std::optional<std::set<std::uint32_t>> that_can_fire(const net::Net& net) {
  const auto graph = ReachabilityGraph::of(oracle::petri_net(net), 3000);
  if (!graph) return std::nullopt;
  std::set<std::uint32_t> can;
  for (const ReachabilityGraph::Edge& edge : graph->edges()) can.insert(edge.transition);
  return can;
}

/// The end of a run, and the report about it.
class RunEnd {
 public:
  RunEnd(const net::Net& net, std::set<std::uint32_t> can_fire) : net_(net), can_fire_(std::move(can_fire)) {
    for (const std::uint32_t transition : can_fire_)
      if (const net::SubsystemId subsystem = net.transitions()[transition].subsystem; subsystem.valid())
        moving_.insert(net.parts()[subsystem].path);
  }

  void expect_true(const std::string& wait) const {
    SCOPED_TRACE(wait);
    const std::string who = wait.substr(0, wait.find(' '));
    const std::string does = wait.substr(who.size() + 1);
    const bool goes_on = does.starts_with("goes on");
    EXPECT_EQ(moving_.contains(who), goes_on);
    if (does.starts_with("goes on and sends ")) {
      const std::size_t at = std::string("goes on and sends ").size();
      const std::string place = does.substr(at, does.find(' ', at) - at) + ".full";
      EXPECT_FALSE(gives(who, place)) << "it sends again";
    }
    if (does.starts_with("waits for")) {
      const std::size_t at = wait.find(" of ") + 4;
      const std::string channel = wait.substr(at, wait.find_first_of(" ,", at) - at);
      const char* state = does.starts_with("waits for a value")               ? ".full"
                          : does.starts_with("waits for the acknowledgement") ? ".ack"
                                                                              : nullptr;
      if (state == nullptr) return;
      for (const net::Place& place : net_.places()) {
        if (place.name == channel + state) {
          EXPECT_EQ(place.tokens, 0U);
        }
      }
    }
  }
  [[nodiscard]] bool moves(const std::string& subsystem) const { return moving_.contains(subsystem); }
  [[nodiscard]] bool is_read(const std::string& channel) const {
    return std::ranges::any_of(can_fire_, [&](std::uint32_t transition) {
      const auto outputs = net_.postset({transition});
      return std::ranges::any_of(outputs,
                                 [&](const net::Arc& arc) {
                                   return net_[arc.place].operation.kind == net::Operation::Kind::read;
                                 }) &&
             std::ranges::any_of(net_.preset({transition}), [&](const net::Arc& arc) {
               return net_[arc.place].fused() && net_[arc.place].name.starts_with(channel + ".");
             });
    });
  }

 private:
  [[nodiscard]] bool gives(const std::string& who, const std::string& place) const {
    const auto there = [&](const net::Arc& arc) { return net_[arc.place].name == place; };
    return std::ranges::any_of(can_fire_, [&](std::uint32_t transition) {
      const net::SubsystemId subsystem = net_.transitions()[transition].subsystem;
      return subsystem.valid() && net_.parts()[subsystem].path == who &&
             std::ranges::any_of(net_.postset({transition}), there) &&
             std::ranges::none_of(net_.preset({transition}), there);
    });
  }

  const net::Net& net_;
  std::set<std::uint32_t> can_fire_;
  std::set<std::string> moving_;
};

/// Each entry of `next` in the run follows an ending after which the controller can take it.
void expect_fitting_endings(const spec::Model& model, const net::Net& net,
                            const std::vector<net::TransitionId>& run, bool failures) {
  using Kind = net::Condition::Kind;
  std::map<net::SubsystemId, std::pair<const spec::Behaviour*, bool>> ended;  // terminal?
  for (const net::TransitionId id : run) {
    const net::Transition& fired = net[id];
    const Kind kind = fired.condition.kind;
    if (kind == Kind::terminal || kind == Kind::error)
      ended[fired.subsystem] = {test::behaviour_of(model, fired), kind == Kind::terminal};
    if (kind != Kind::next) continue;
    const auto [behaviour, terminal] = ended.at(fired.subsystem);
    const int entry = fired.condition.entry ? static_cast<int>(*fired.condition.entry) : -1;
    const test::NaiveEndings endings = test::try_endings(*behaviour);
    const bool fits = terminal ? endings.after(spec::Ending::terminal).contains(entry)
                               : endings.after(spec::Ending::error).contains(entry) ||
                                     (failures && endings.after(spec::Ending::failure).contains(entry));
    EXPECT_TRUE(fits) << fired.name << " after " << (terminal ? "t5" : "t6");
  }
}

struct Tally {
  std::map<std::string, std::array<int, 3>> verdicts;
};

class Comparison {
 public:
  Comparison(const spec::Model& model, const test::Built& built,
             const std::vector<net::Invariant>& invariants, Tally& tally)
      : model_(model), built_(built), invariants_(invariants), tally_(tally) {}

  void with(const std::string& method, const Truth& found) {
    const test::NaiveAnswers& naive = found.conditions;
    ProveOptions options;
    options.method = method;
    const Report report = prove({built_.net, &built_.pages, invariants_}, options);
    std::map<std::string, bool> truth{
        {"safe", true},
        {"exclusive_channels", true},
        {"sound_pages", true},
        {"deadlock_free", !naive.deadlock},
        {"goes_on", !any(naive.stuck)},
    };
    if (found.failures)
      truth["survives_exceptions"] = !found.failures->deadlock && !any(found.failures->stuck);
    if (found.failures) truth["live_behaviours"] = found.dead_for_good.empty();
    if (const std::optional<bool> flow = channels_flow(naive)) truth["channels_flow"] = *flow;
    for (const PropertyResult& property : report.properties) {
      ++tally_.verdicts[property.name][static_cast<std::size_t>(property.verdict)];
      if (!truth.contains(property.name) || property.verdict == Verdict::unknown) continue;
      EXPECT_EQ(property.verdict == Verdict::holds, truth.at(property.name))
          << property.name << " by " << property.method << ": " << property.why;
      if (property.has_trace) shows(property);
      if (method.empty() && property.name == "live_behaviours")
        names_all(property, property.verdict == Verdict::holds ? found.dead : found.dead_for_good);
    }
  }

 private:
  /// The search calls a channel dry as soon as its reader is about to end; the property does not. So there is
  /// no comparison if that is the only difference.
  static std::optional<bool> channels_flow(const test::NaiveAnswers& naive) {
    bool unclear = false;
    for (std::size_t channel = 0; channel < naive.dry.size(); ++channel) {
      if (naive.dry[channel] && !naive.reader_can_end[channel]) return false;
      unclear = unclear || naive.dry[channel];
    }
    return unclear ? std::nullopt : std::optional(true);
  }

  static void names_all(const PropertyResult& property, const std::set<std::string>& dead) {
    std::set<std::string> named;
    for (const PropertyResult::Behaviour& one : property.behaviours) named.insert(one.path);
    EXPECT_EQ(named, dead);
  }

  void shows(const PropertyResult& property) const {
    const net::Net abstract =
        abstract_net(built_.net, property.exceptions ? Assume::exceptions : Assume::conditions);
    const net::Net after = starting_in(abstract, end_of(abstract, property.trace));
    expect_fitting_endings(model_, abstract, property.trace, property.exceptions);
    const auto can_fire = that_can_fire(after);
    if (!can_fire) return;
    const RunEnd end(after, *can_fire);
    for (const SubsystemAtEnd& wait : property.waits) end.expect_true(wait.text);
    if (property.name == "deadlock_free") {
      EXPECT_TRUE(can_fire->empty()) << "the run ends in no dead marking";
    }
    if (property.name == "goes_on" || (property.exceptions && !can_fire->empty())) {
      ASSERT_FALSE(property.waits.empty())
          << property.name << " (" << property.method << "): " << property.why;
      if (property.name == "goes_on") {  // the one that is named, not another that gets stuck too
        EXPECT_FALSE(end.moves(property.why.substr(0, property.why.find(' ')))) << property.why;
      }
      EXPECT_FALSE(end.moves(property.waits.front().path));
    }
    if (property.name == "channels_flow") {
      const std::string channel = property.why.substr(0, property.why.find(' '));
      EXPECT_FALSE(end.is_read(channel)) << "the run ends where " << channel << " can be read again";
      // A reader that need not wait goes on although its sender never gives it another value.
      const std::string to = channel.substr(channel.find("->") + 2);
      EXPECT_TRUE(!property.waits.empty() || end.moves(to.substr(0, to.rfind('.')))) << property.why;
    }
  }

  const spec::Model& model_;
  const test::Built& built_;
  const std::vector<net::Invariant>& invariants_;
  Tally& tally_;
};

/// Every method by itself and all together, on as many systems as are small enough for the search.
Tally compared(spec::Model (*system)(std::uint64_t seed), std::uint64_t systems) {
  std::uint64_t seed = from_environment("TESSERA_RANDOM_SEED", 0);
  Tally tally, of_methods;
  for (std::uint64_t compared = 0; compared < systems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const spec::Model model = system(seed);
    const test::Built built = test::build(model);
    const std::optional<Truth> truth = truth_of(model, built.net);
    if (!truth) continue;
    ++compared;
    const std::vector<net::Invariant> invariants = layers::invariants(model, built.pages, built.net);
    Comparison(model, built, invariants, tally).with("", *truth);
    for (const std::string& method : method_names())
      Comparison(model, built, invariants, of_methods).with(method, *truth);
    if (testing::Test::HasFailure()) break;
  }
  return tally;
}

void expect_both_verdicts(Tally tally) {
  for (const char* name : {"deadlock_free", "goes_on", "channels_flow", "survives_exceptions"}) {
    const auto& [holds, violated, unknown] = tally.verdicts[name];
    EXPECT_EQ(unknown, 0) << name;
    if (sanitized) continue;  // the few systems there need not have both
    EXPECT_GT(holds, 0) << name;
    EXPECT_GT(violated, 0) << name;
  }
}

TEST(Prove, AgreesWithExhaustiveSearchOnRandomSystems) {
  expect_both_verdicts(
      compared(test::random_system, from_environment("TESSERA_RANDOM_SYSTEMS", share_of(150))));
}

TEST(Prove, AgreesWithExhaustiveSearchOnRandomSystemsOfOwnModels) {
  expect_both_verdicts(
      compared(test::random_system_of_own_models, from_environment("TESSERA_RANDOM_SYSTEMS", share_of(100))));
}

spec::Model random_system_with_endings(std::uint64_t seed) {
  spec::Model model = seed % 2 == 0 ? test::random_system(seed) : test::random_system_of_own_models(seed);
  test::draw_endings(model, seed);
  return model;
}

TEST(Prove, AgreesWithExhaustiveSearchHoweverBehavioursEnd) {
  expect_both_verdicts(
      compared(random_system_with_endings, from_environment("TESSERA_RANDOM_SYSTEMS", share_of(100))));
}

}  // namespace
}  // namespace tessera::verify
