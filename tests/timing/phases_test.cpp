// Chains over processes whose grids have any phases, and over foreign nodes: a simulation of its own beside the bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "timing/declared.hpp"

namespace tessera::timing {
namespace {

/// A value that comes, or is given, at a time, and the reading that it is based on; less than 0: none.
struct Given {
  Time time = 0, sampled = -1;
};

/// Subsystems in a row, each of which sends to the next one without waiting. Some of them are joined by a foreign node.
class Row {
 public:
  explicit Row(std::uint64_t seed) : random_(seed) {
    const std::size_t count = 2 + below(4), processes = 1 + below(3);
    for (std::size_t process = 0; process < processes; ++process)
      phases_.push_back(static_cast<Time>(below(100)));
    for (std::uint32_t i = 0; i < count; ++i) {
      Subsystem& one = system.subsystems.emplace_back();
      one.process = static_cast<std::uint32_t>(below(processes));
      one.period = std::array{10, 20, 40, 50, 100}[below(5)];
      one.shortest = 1 + static_cast<Time>(below(4));
      one.longest = one.shortest + static_cast<Time>(below(6));
      if (i > 0) join(i, static_cast<Time>(std::array{1, 7, 25, 60}[seed % 4]));
    }
  }

  System system;
  Chain way;
  std::vector<ForeignHop> foreign;

  /// The largest age and reaction of a run, of readings after the start.
  struct Times {
    Time age = 0, reaction = 0;
  };
  Times run(Time until) {
    std::vector<Time> samples;
    std::vector<Given> given;
    for (std::uint32_t i = 0; i < system.subsystems.size(); ++i) given = pass(i, until, given, samples);
    Times most;
    const Time settled = 600;
    std::size_t at = 0;
    for (const Given& command : given)
      if (command.sampled >= settled) most.age = std::max(most.age, command.time - command.sampled);
    for (const Time sample : samples) {
      while (at < given.size() && given[at].sampled <= sample) ++at;
      if (at == given.size()) break;
      if (sample >= settled) most.reaction = std::max(most.reaction, given[at].time - sample);
    }
    return most;
  }

 private:
  std::size_t below(std::size_t count) { return random_() % count; }
  Time between(Time least, Time most) {
    const std::size_t drawn = below(4);
    if (drawn == 0) return least;
    return drawn == 1 ? most : least + static_cast<Time>(below(static_cast<std::size_t>(most - least + 1)));
  }

  void join(std::uint32_t i, Time network) {
    // The parts of a chain have a channel each.
    const bool is_last = foreign.empty() ? way.empty() : foreign.back().after == way.size();
    if (!is_last && below(3) == 0 && i + 1 < 5) {
      const Time least = static_cast<Time>(below(10));
      foreign.push_back({"node", least, least + static_cast<Time>(below(30)), way.size()});
      answers_.push_back(i);
      return;
    }
    const auto c = static_cast<std::uint32_t>(system.channels.size());
    Channel& one = system.channels.emplace_back();
    one.from = i - 1;
    one.to = i;
    one.receive_blocks = below(3) == 0;
    system.subsystems[i - 1].sends.push_back(c);
    system.subsystems[i].receives.push_back(c);
    if (one.receive_blocks && below(2) == 0) system.subsystems[i].period = 0;
    if (system.crosses(c)) one.network = network;
    way.push_back(c);
  }

 public:
  /// A foreign node stands before two subsystems at least.
  [[nodiscard]] bool is_whole() const {
    return !way.empty() && (foreign.empty() || foreign.back().after < way.size());
  }

 private:
  std::vector<Given> pass(std::uint32_t i, Time until, std::vector<Given> arriving,
                          std::vector<Time>& samples) {
    const Subsystem& one = system.subsystems[i];
    const bool is_first = i == 0, answers = std::ranges::find(answers_, i) != answers_.end();
    const Channel* const channel = is_first || answers ? nullptr : &system.channels[one.receives.front()];
    Time least = 0, most = 0, last = 0;
    if (answers) {
      const ForeignHop& hop =
          foreign[static_cast<std::size_t>(std::ranges::find(answers_, i) - answers_.begin())];
      least = hop.shortest;
      most = hop.longest;
    } else if (channel != nullptr) {
      most = channel->network;
    }
    for (Given& value : arriving) last = value.time = std::max(last, value.time + between(least, most));
    const Time phase = phases_[one.process];
    std::vector<Given> given;
    std::size_t next = 0;  // values before this one have been taken
    Time held = -1;
    for (Time start = one.period > 0 ? phase : 0; start < until;) {
      const auto take = [&](Time by) {
        // A write at the very instant of a read may be missed.
        const Time closed = below(2) == 0 ? by : by - 1;
        while (next < arriving.size() && arriving[next].time <= closed) held = arriving[next++].sampled;
      };
      if (answers) take(start);
      if (is_first) samples.push_back(held = start);
      const Time end = start + between(one.shortest, one.longest);
      given.push_back({end, held});
      Time done = end;
      if (channel != nullptr && channel->receive_blocks) {
        if (next >= arriving.size()) break;
        done = std::max(end, arriving[next].time);
        while (next < arriving.size() && arriving[next].time <= done) held = arriving[next++].sampled;
      } else if (channel != nullptr) {
        take(done);
      }
      if (one.period == 0)
        start = done;
      else
        start = std::max(start + one.period, phase + ceil_div(done - phase, one.period) * one.period);
    }
    return given;
  }

  std::mt19937_64 random_;
  std::vector<Time> phases_;            ///< per process
  std::vector<std::uint32_t> answers_;  ///< those that read what a foreign node answers
};

// TESSERA_TIMING_PHASES=100000 runs so many systems.
TEST(Phases, ExceedNoBoundBetweenProcessesAndOverForeignNodes) {
  const char* const asked = std::getenv("TESSERA_TIMING_PHASES");
  const std::uint64_t systems = asked == nullptr ? 4000 : std::strtoull(asked, nullptr, 10);
  std::uint64_t crossing = 0, foreign = 0;
  std::vector<double> reach;
  for (std::uint64_t seed = 1; seed <= systems && !HasFailure(); ++seed) {
    Row row(seed);
    if (!row.is_whole()) continue;
    const Bounds bounds(row.system);
    const ChainBound bound = bound_of(bounds, row.way, row.foreign);
    if (bound.reaction >= unbounded) continue;
    const Row::Times seen = row.run(8000);
    EXPECT_LE(seen.age, bound.age) << "seed " << seed;
    EXPECT_LE(seen.reaction, bound.reaction) << "seed " << seed;
    foreign += row.foreign.empty() ? 0 : 1;
    crossing += std::ranges::any_of(row.way, [&](std::uint32_t c) { return row.system.crosses(c); }) ? 1 : 0;
    reach.push_back(static_cast<double>(seen.reaction) / static_cast<double>(bound.reaction));
  }
  EXPECT_GT(crossing, systems / 4);
  EXPECT_GT(foreign, systems / 8);
  std::ranges::sort(reach);
  if (asked != nullptr)
    printf("%zu chains, median of reaction / bound %.2f\n", reach.size(), reach[reach.size() / 2]);
}

/// Two subsystems of one period that wait for each other: 0 asks, and 1 answers.
System dialogue(std::uint32_t process_of_answer) {
  System system;
  for (std::uint32_t i = 0; i < 2; ++i) {
    Subsystem& one = system.subsystems.emplace_back();
    one.period = 100;
    one.longest = 5;
    one.process = i * process_of_answer;
  }
  for (std::uint32_t c = 0; c < 2; ++c) {
    Channel& one = system.channels.emplace_back();
    one.from = c;
    one.to = 1 - c;
    one.receive_blocks = true;
    one.network = 10 * process_of_answer;
    system.subsystems[c].sends.push_back(c);
    system.subsystems[1 - c].receives.push_back(c);
  }
  return system;
}

/// In one process, all releases come together, and the answer comes within a period. The release of another process may
/// come just after a question.
TEST(Phases, NobodyIsInStepWithAnotherProcess) {
  const Occurrences together(dialogue(0)), apart(dialogue(1));
  EXPECT_TRUE(together.in_step(0, 1));
  EXPECT_TRUE(together.periodic(0));
  EXPECT_FALSE(apart.in_step(0, 1));
  EXPECT_FALSE(apart.periodic(0));
}

TEST(Phases, AValueOfAnotherProcessDrivesNobody) {
  System system = dialogue(0);
  system.channels.pop_back();
  system.subsystems[1].sends.clear();
  system.subsystems[0].receives.clear();
  system.subsystems[1].period = 0;
  const Occurrences together(system);
  EXPECT_EQ(Clocked(together).driver(1), 0U);
  system.subsystems[1].process = 1;
  system.channels[0].network = 10;
  const Occurrences apart(system);
  EXPECT_FALSE(Clocked(apart).knows(1));
}

}  // namespace
}  // namespace tessera::timing
