#include "verify/waiting/waiting.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "../environment.hpp"
#include "verify_circuits/judged.hpp"
#include "verify_circuits/naive_answers.hpp"
#include "verify_circuits/random_system.hpp"

namespace tessera::test {
namespace {

verify::WaitingReport waiting(const Judged& judged) {
  std::vector<const verify::CircuitGroup*> groups;
  for (const verify::CircuitGroup& group : judged.report.groups) groups.push_back(&group);
  return verify::judge_waiting(judged.structure, groups, {});
}

bool all(const std::vector<bool>& flags) {
  return std::ranges::all_of(flags, [](bool flag) { return flag; });
}

// Two behaviours of a, one that talks to b and one that talks to c, in any order.
TEST(Waiting, BehavioursThatUseDifferentChannelsOfATreeGoOn) {
  SystemBuilder builder;
  const spec::InstanceId a = builder.subsystem(), b = builder.subsystem(), c = builder.subsystem();
  const SystemBuilder::Ends both{true, true};
  const spec::ChannelId to_b = builder.channel(a, b, both), to_c = builder.channel(a, c, both);
  builder.behaviour(a, {to_b}, {});
  builder.behaviour(a, {to_c}, {});
  builder.leave(a, {0}, false, {{1}});
  builder.leave(a, {1}, false, {{0}});
  builder.behaviour(b, {}, {to_b});
  builder.behaviour(c, {}, {to_c});
  const Judged judged = judge(builder.result());
  ASSERT_FALSE(judged.report.groups.front().applies());
  const verify::WaitingReport report = waiting(judged);
  EXPECT_TRUE(all(report.goes_on)) << report.why_not;
  EXPECT_TRUE(all(verify::flowing_channels(judged.structure, report.goes_on)));
}

/// A ring. In one behaviour, each sends to the next and waits for the one before; in
/// the other, it only rests.
Judged ring(std::uint32_t size, bool receive_first) {
  SystemBuilder builder;
  for (std::uint32_t index = 0; index < size; ++index) builder.subsystem();
  std::vector<spec::ChannelId> channels;
  for (std::uint32_t index = 0; index < size; ++index)
    channels.push_back(builder.channel({index}, {(index + 1) % size}, {false, true}));
  for (std::uint32_t index = 0; index < size; ++index) {
    const spec::InstanceId instance{index};
    const spec::ChannelId out = channels[index], in = channels[(index + size - 1) % size];
    if (receive_first) {
      builder.behaviour(instance, {}, {in});
      builder.behaviour(instance, {out}, {});
      builder.leave(instance, {0}, true, {{1}});
    } else {
      builder.behaviour(instance, {out}, {in});
      builder.behaviour(instance, {}, {});
      builder.leave(instance, {0}, false, {{1}});
    }
    builder.leave(instance, {1}, receive_first, {{0}});
  }
  return judge(builder.result());
}

TEST(Waiting, ARingGoesOnWhereverEachSendsBeforeItWaits) {
  const Judged judged = ring(50, false);
  ASSERT_FALSE(judged.report.groups.front().applies());
  const verify::WaitingReport report = waiting(judged);
  EXPECT_TRUE(all(report.goes_on)) << report.why_not;
  EXPECT_GT(report.traps, 0U);
}

TEST(Waiting, ARingThatWaitsBeforeItSendsIsSuspected) {
  const verify::WaitingReport report = waiting(ring(3, true));
  EXPECT_TRUE(std::ranges::none_of(report.goes_on, [](bool flag) { return flag; }));
  EXPECT_NE(report.why_not.find("it is not excluded that"), std::string::npos) << report.why_not;
  EXPECT_NE(report.why_not.find("a0.s0 waits for a value"), std::string::npos) << report.why_not;
}

TEST(Waiting, APeerThatNeedNotComeBackIsNamed) {
  SystemBuilder builder;
  const spec::InstanceId a = builder.subsystem(), b = builder.subsystem();
  const spec::ChannelId channel = builder.channel(a, b, {false, true});
  builder.behaviour(a, {channel}, {});
  builder.behaviour(a, {}, {});
  builder.leave(a, {0}, true, {{1}});
  builder.behaviour(b, {}, {channel});
  const verify::WaitingReport report = waiting(judge(builder.result()));
  EXPECT_NE(report.why_not.find("for a0.s0, which need not come back to it"), std::string::npos)
      << report.why_not;
}

TEST(Waiting, ALimitIsKept) {
  const Judged judged = ring(5, false);
  std::vector<const verify::CircuitGroup*> groups;
  for (const verify::CircuitGroup& group : judged.report.groups) groups.push_back(&group);
  explore::Limits limits;
  limits.time = std::chrono::duration<double>(0);
  const verify::WaitingReport report = verify::judge_waiting(judged.structure, groups, limits);
  EXPECT_TRUE(std::ranges::none_of(report.goes_on, [](bool flag) { return flag; }));
  EXPECT_NE(report.why_not.find("time limit"), std::string::npos) << report.why_not;
}

struct WaitingTally {
  std::uint64_t compared = 0, going_on = 0, cleared = 0, beyond_circuits = 0, flowing = 0, seen_to_flow = 0;
};

/// The claims are true.
void compare(const Judged& judged, const verify::WaitingReport& report, const NaiveAnswers& naive,
             WaitingTally& tally) {
  for (const verify::CircuitGroup& group : judged.report.groups)
    for (const verify::SubsystemFlowId flow : group.subsystems) {
      const verify::SubsystemFlow& subsystem = judged.structure[flow];
      const bool stuck = naive.stuck[subsystem.id.value];
      tally.going_on += stuck ? 0 : 1;
      if (!report.goes_on[flow.value]) continue;
      ++tally.cleared;
      tally.beyond_circuits += group.applies() ? 0 : 1;
      EXPECT_FALSE(stuck) << subsystem.name;
    }
  const std::vector<bool> flows = verify::flowing_channels(judged.structure, report.goes_on);
  for (std::uint32_t index = 0; index < flows.size(); ++index) {
    const std::uint32_t id = judged.structure.channels[index].id.value;
    const bool dry = id >= naive.dry.size() || naive.dry[id];  // the naive answers end with the channels that
                                                               // are read
    tally.flowing += dry ? 0 : 1;
    if (!flows[index]) continue;
    ++tally.seen_to_flow;
    EXPECT_FALSE(dry) << judged.structure.channels[index].name;
  }
}

TEST(Waiting, ClaimsNothingThatExhaustiveSearchContradicts) {
  const std::uint64_t systems = from_environment("TESSERA_RANDOM_SYSTEMS", share_of(300));
  std::uint64_t seed = from_environment("TESSERA_RANDOM_SEED", 0);
  const std::size_t most_markings = systems > 10000 ? 6000 : 1500;
  WaitingTally tally;
  for (; tally.compared < systems; ++seed) {
    const net::Net net = flat_net(random_differing_system(seed));
    const auto naive = explore_naively(net, most_markings);
    if (!naive) continue;
    ++tally.compared;
    const Judged judged = judge(net);
    const verify::WaitingReport report = waiting(judged);
    compare(judged, report, *naive, tally);
    ASSERT_FALSE(HasFailure()) << "seed " << seed << "\n" << in_text(judged.structure);
  }
  std::printf(
      "%llu systems; subsystems that go on %llu, cleared %llu, of them %llu beyond circuits; channels that "
      "flow "
      "%llu, seen to %llu\n",
      static_cast<unsigned long long>(tally.compared), static_cast<unsigned long long>(tally.going_on),
      static_cast<unsigned long long>(tally.cleared), static_cast<unsigned long long>(tally.beyond_circuits),
      static_cast<unsigned long long>(tally.flowing), static_cast<unsigned long long>(tally.seen_to_flow));
  EXPECT_GT(tally.cleared, tally.going_on / 2);
  EXPECT_GT(tally.beyond_circuits, systems / 20);
}

}  // namespace
}  // namespace tessera::test
