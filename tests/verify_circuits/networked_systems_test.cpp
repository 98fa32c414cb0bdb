#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../environment.hpp"
#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "verify/circuits/strict_sides.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/verify.hpp"
#include "verify/waiting/waiting.hpp"
#include "verify_circuits/judged.hpp"
#include "verify_circuits/naive_answers.hpp"
#include "verify_circuits/random_system.hpp"

namespace tessera::test {
namespace {

using verify::Answer;
using verify::Assume;

/// Every agent of the model in a process of its own, or the first ones together.
spec::Model deployed(spec::Model model, std::uint32_t together = 1) {
  spec::Deployment deployment;
  for (const spec::AgentId agent : model.agents.ids()) {
    if (agent.value == 0 || agent.value >= together) deployment.processes.push_back({});
    spec::Process& process = deployment.processes.back();
    if (process.agents.empty()) process.name = "p" + std::to_string(deployment.processes.size() - 1);
    process.agents.push_back(agent);
    model.agents[agent].process = {static_cast<std::uint32_t>(deployment.processes.size() - 1)};
  }
  model.deployment = std::move(deployment);
  return model;
}

bool crosses(const spec::Model& model) {
  return std::ranges::any_of(model.channels,
                             [&](const spec::Channel& channel) { return model.crosses_processes(channel); });
}

bool any_of(const std::vector<bool>& flags) { return std::ranges::count(flags, true) > 0; }

struct NetworkTally {
  std::uint64_t compared = 0, too_large = 0, folded = 0, good = 0, stuck = 0, deadlocks = 0, dry = 0;
  std::uint64_t waiting = 0, survives = 0, strict = 0, only_by_cut = 0;
};

/// Circuits and waits, which read off the net what each side does, against all markings of the net.
void compare_verdicts(const net::Net& net, const NaiveAnswers& naive, NetworkTally& tally) {
  const Judged judged = judge(net);
  const verify::CircuitReport& report = judged.report;
  if (report.goes_on != Answer::unknown) {
    ++tally.folded;
    EXPECT_EQ(report.goes_on == Answer::yes, !any_of(naive.stuck));
    ++(any_of(naive.stuck) ? tally.stuck : tally.good);
  }
  if (report.deadlock_free != Answer::unknown) {
    EXPECT_EQ(report.deadlock_free == Answer::yes, !naive.deadlock);
    tally.deadlocks += naive.deadlock ? 1 : 0;
  }
  for (const verify::CircuitGroup& group : report.groups)
    for (const verify::SubsystemFlowId subsystem : group.subsystems) {
      if (!group.applies()) continue;
      EXPECT_EQ(std::ranges::count(group.stuck, subsystem) > 0,
                naive.stuck[judged.structure[subsystem].id.value])
          << judged.structure[subsystem].name;
    }
  for (std::uint32_t index = 0; index < judged.structure.channels.size(); ++index) {
    const verify::ChannelFlowId flow{index};
    if (std::ranges::count(report.unclear, flow) > 0) continue;
    const bool dry = std::ranges::count(report.dry, flow) > 0;
    EXPECT_EQ(dry, naive.dry[judged.structure[flow].id.value]) << judged.structure[flow].name;
    tally.dry += dry ? 1 : 0;
  }
  std::vector<const verify::CircuitGroup*> refused;
  for (const verify::CircuitGroup& group : report.groups) refused.push_back(&group);
  const verify::WaitingReport waiting = verify::judge_waiting(judged.structure, refused, {});
  for (std::uint32_t index = 0; index < waiting.goes_on.size(); ++index)
    if (waiting.goes_on[index]) {
      ++tally.waiting;
      EXPECT_FALSE(naive.stuck[judged.structure.subsystems[index].id.value])
          << judged.structure.subsystems[index].name;
    }
}

/// The linear rule: a system survives if it goes on with a fair network and no side waits for it for ever.
void compare_partition(const net::Net& net, const NaiveAnswers& fair, const NaiveAnswers& cut,
                       NetworkTally& tally) {
  const Judged judged = judge(net);
  const std::vector<verify::StrictSide> strict = verify::strict_sides(judged.structure);
  EXPECT_EQ(strict.empty() && !any_of(fair.stuck), !any_of(cut.stuck));
  if (strict.empty()) {
    EXPECT_EQ(fair.deadlock, cut.deadlock);
  }
  for (const verify::StrictSide& side : strict)
    EXPECT_TRUE(cut.stuck[judged.structure[side.subsystem].id.value])
        << judged.structure[side.subsystem].name;
  ++(any_of(cut.stuck) ? tally.strict : tally.survives);
  tally.only_by_cut += any_of(cut.stuck) && !any_of(fair.stuck) ? 1 : 0;
}

void expect_safe_by_invariants(const spec::Model& model) {
  diagnostics::Diagnostics out("system.yaml", "");
  const auto pages = layers::build(model, out);
  ASSERT_TRUE(pages);
  const auto net = net::flatten(*pages, out);
  ASSERT_TRUE(net);
  const std::vector<net::Invariant> invariants = layers::invariants(model, *pages, *net);
  verify::ProveOptions options;
  options.method = "invariants";
  options.only = {"safe", "exclusive_channels"};
  for (const verify::PropertyResult& property :
       verify::prove({*net, &*pages, invariants}, options).properties)
    EXPECT_EQ(property.verdict, verify::Verdict::holds) << property.name << ": " << property.why;
}

void compare_deployed(spec::Model (*random)(std::uint64_t), std::uint64_t systems, NetworkTally& tally) {
  const std::uint64_t first = from_environment("TESSERA_RANDOM_SEED", 0);
  for (std::uint64_t seed = first; tally.compared < systems; ++seed) {
    const spec::Model model = deployed(random(seed), 1 + static_cast<std::uint32_t>(seed % 2));
    if (!crosses(model)) continue;
    SCOPED_TRACE("seed " + std::to_string(seed));
    const net::Net net = flat_net(model);
    const auto fair = explore_naively(net, 1500);
    const auto cut = fair ? explore_naively(verify::abstract_net(net, Assume::partition), 6'000)
                          : std::optional<NaiveAnswers>();
    if (!cut) {
      ++tally.too_large;
      continue;
    }
    ++tally.compared;
    expect_safe_by_invariants(model);
    compare_verdicts(net, *fair, tally);
    compare_partition(net, *fair, *cut, tally);
    if (testing::Test::HasFailure()) {
      ADD_FAILURE() << in_text(judge(net).structure);
      break;
    }
  }
}

TEST(NetworkedSystems, AgreeWithExhaustiveSearch) {
  const std::uint64_t systems = from_environment("TESSERA_RANDOM_SYSTEMS", share_of(200));
  NetworkTally tally;
  compare_deployed(random_system, systems, tally);
  RecordProperty("compared", static_cast<int>(tally.compared));
  RecordProperty("too_large", static_cast<int>(tally.too_large));
  RecordProperty("survive", static_cast<int>(tally.survives));
  EXPECT_GT(tally.folded, systems / 2);
  if (sanitized) return;  // a tenth of the systems need not show every kind
  for (const std::uint64_t seen : {tally.good, tally.stuck, tally.deadlocks, tally.dry, tally.waiting,
                                   tally.survives, tally.strict, tally.only_by_cut})
    EXPECT_GT(seen, 0U);
}

TEST(NetworkedSystems, AgreeWithExhaustiveSearchWhereBehavioursDiffer) {
  const std::uint64_t systems = from_environment("TESSERA_RANDOM_SYSTEMS", share_of(200)) / 2;
  NetworkTally tally;
  compare_deployed(random_differing_system, systems, tally);
  if (sanitized) return;  // a tenth of the systems need not show every kind
  EXPECT_GT(tally.waiting, 0U);
  EXPECT_GT(tally.survives, 0U);
  EXPECT_GT(tally.only_by_cut, 0U);
}

}  // namespace
}  // namespace tessera::test
