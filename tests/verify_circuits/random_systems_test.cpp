#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "../environment.hpp"
#include "verify_circuits/judged.hpp"
#include "verify_circuits/naive_answers.hpp"
#include "verify_circuits/random_system.hpp"

namespace tessera::test {
namespace {

using verify::Answer;

/// The long form of the test: TESSERA_RANDOM_SYSTEMS=100000.
struct Tally {
  std::uint64_t compared = 0, too_large = 0, refused = 0, good = 0, stuck = 0, deadlocks = 0, free = 0;
  std::uint64_t flowing = 0, dry = 0, unclear = 0;
  std::uint64_t causes[5] = {};
};

class Comparison {
 public:
  Comparison(const Judged& judged, const NaiveAnswers& naive, Tally& tally)
      : judged_(judged), naive_(naive), tally_(tally) {}

  void all() {
    std::vector<bool> said(judged_.structure.subsystems.size(), false);
    for (const verify::CircuitGroup& group : judged_.report.groups) {
      if (!group.applies()) {
        ++tally_.refused;
        continue;
      }
      ++tally_.causes[static_cast<int>(group.cause)];
      for (const verify::SubsystemFlowId subsystem : group.stuck) said[subsystem.value] = true;
      for (const verify::SubsystemFlowId subsystem : group.subsystems)
        EXPECT_EQ(said[subsystem.value], naive_.stuck[judged_.structure[subsystem].id.value])
            << judged_.structure[subsystem].name << ": " << verify::in_words(judged_.structure, group);
      circuit(group);
    }
    overall();
    channels();
  }

 private:
  void circuit(const verify::CircuitGroup& group) const {
    EXPECT_EQ(group.stuck.empty(), group.circuit.empty());
    for (std::size_t step = 0; step + 1 < group.circuit.size(); ++step)
      EXPECT_EQ(group.circuit[step].waiting_for, group.circuit[step + 1].subsystem);
    if (group.cause == verify::CircuitGroup::Cause::no_token ||
        group.cause == verify::CircuitGroup::Cause::lost_token) {
      EXPECT_EQ(group.circuit.back().waiting_for, group.circuit.front().subsystem);
    }
  }

  void overall() const {
    const bool naive_goes_on = std::ranges::none_of(naive_.stuck, [](bool stuck) { return stuck; });
    if (judged_.report.goes_on != Answer::unknown) {
      EXPECT_EQ(judged_.report.goes_on == Answer::yes, naive_goes_on);
      ++(naive_goes_on ? tally_.good : tally_.stuck);
    }
    if (judged_.report.deadlock_free != Answer::unknown) {
      EXPECT_EQ(judged_.report.deadlock_free == Answer::yes, !naive_.deadlock);
      ++(naive_.deadlock ? tally_.deadlocks : tally_.free);
    }
  }

  void channels() const {
    for (std::uint32_t index = 0; index < judged_.structure.channels.size(); ++index) {
      const verify::ChannelFlowId flow{index};
      const verify::ChannelFlow& channel = judged_.structure[flow];
      if (std::ranges::count(judged_.report.unclear, flow) > 0) {
        ++tally_.unclear;
        continue;
      }
      ASSERT_LT(channel.id.value, naive_.dry.size());
      const bool dry = std::ranges::count(judged_.report.dry, flow) > 0;
      EXPECT_EQ(dry, naive_.dry[channel.id.value]) << channel.name;
      EXPECT_FALSE(naive_.reader_can_end[channel.id.value]) << channel.name;
      ++(dry ? tally_.dry : tally_.flowing);
    }
  }

  const Judged& judged_;
  const NaiveAnswers& naive_;
  Tally& tally_;
};

TEST(Circuits, AgreeWithExhaustiveSearchOnRandomSystems) {
  const std::uint64_t systems = from_environment("TESSERA_RANDOM_SYSTEMS", share_of(1000));
  const std::uint64_t first = from_environment("TESSERA_RANDOM_SEED", 0);
  const std::size_t most_markings = systems > 10000 ? 12000 : 3000;
  Tally tally;
  std::uint64_t seed = first;
  for (; tally.compared < systems; ++seed) {
    const net::Net net = flat_net(random_system(seed));
    const Judged judged = judge(net);
    const auto naive = explore_naively(net, most_markings);
    if (!naive) {
      ++tally.too_large;
      continue;
    }
    ++tally.compared;
    Comparison(judged, *naive, tally).all();
    ASSERT_FALSE(HasFailure()) << "seed " << seed << "\n" << in_text(judged.structure);
  }
  std::printf(
      "%llu systems (%llu more too large); all go on %llu, not %llu; deadlock %llu, none %llu; channels flow "
      "%llu, "
      "dry %llu, unclear %llu; groups refused %llu, causes %llu %llu %llu %llu %llu\n",
      static_cast<unsigned long long>(tally.compared), static_cast<unsigned long long>(tally.too_large),
      static_cast<unsigned long long>(tally.good), static_cast<unsigned long long>(tally.stuck),
      static_cast<unsigned long long>(tally.deadlocks), static_cast<unsigned long long>(tally.free),
      static_cast<unsigned long long>(tally.flowing), static_cast<unsigned long long>(tally.dry),
      static_cast<unsigned long long>(tally.unclear), static_cast<unsigned long long>(tally.refused),
      static_cast<unsigned long long>(tally.causes[0]), static_cast<unsigned long long>(tally.causes[1]),
      static_cast<unsigned long long>(tally.causes[2]), static_cast<unsigned long long>(tally.causes[3]),
      static_cast<unsigned long long>(tally.causes[4]));
  // Each kind of answer was tried.
  for (const std::uint64_t cause : tally.causes) EXPECT_GT(cause, systems / 200);
  EXPECT_GT(tally.good, systems / 10);
  EXPECT_GT(tally.stuck, systems / 10);
  EXPECT_GT(tally.deadlocks, systems / 50);
}

}  // namespace
}  // namespace tessera::test
