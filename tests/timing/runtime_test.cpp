// Random systems on the runtime, under the simulated clock and with `takes` as it draws it, beside their bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "drawn_run.hpp"
#include "drawn_shapes.hpp"
#include "timing/conduct/certain.hpp"
#include "timing/worst/run_scenario.hpp"
#include "timing/worst/worst_run.hpp"

namespace tessera::timing_test {
namespace {

using timing::Bounds;
using timing::ChainBound;
using timing::Occurrences;
using timing::unbounded;

void hold(const char* what, std::size_t index, std::int64_t most_ns, timing::Time bound) {
  EXPECT_LE(most_ns, bound >= unbounded ? INT64_MAX : bound * tick_ns) << what << " " << index;
}

void hold_subsystems(const Observed& seen, const Bounds& all) {
  const Occurrences& bounds = all.occurrences();
  for (std::uint32_t i = 0; i < seen.net().subsystems.size(); ++i) {
    const ::timing::Subsystem& one = seen.net().subsystems[i];
    if (one.period == 0 || (one.catch_up && !bounds.never_overruns(i))) continue;
    std::int64_t gap = 0;
    for (std::size_t k = 1; k < seen.called[i].size(); ++k)
      gap = std::max(gap, seen.called[i][k] - seen.called[i][k - 1]);
    hold("time between calls of", i, gap, all.between_iterations(i));
    if (bounds.periodic(i)) hold("period of", i, gap, one.period);
  }
}

void hold_timeouts(const Observed& seen, const Occurrences& bounds) {
  for (std::uint32_t c = 0; c < seen.net().channels.size(); ++c) {
    const ::timing::Channel& one = seen.net().channels[c];
    if (one.send_blocks && one.send_timeout > 0 && bounds.timeout_never_fires(bounds.events().acked(c))) {
      EXPECT_EQ(seen.send_timeouts[c], 0U) << "channel " << c;
    }
    if (one.receive_blocks && one.receive_timeout > 0 &&
        bounds.timeout_never_fires(bounds.events().read(c))) {
      EXPECT_EQ(seen.receive_timeouts[c], 0U) << "channel " << c;
    }
  }
}

/// Returns how many timeouts must fire, and did.
std::uint64_t hold_certain(const Observed& seen, const Bounds& bounds) {
  const timing::Certain certain(bounds);
  const timing::Events& events = bounds.occurrences().events();
  std::uint64_t count = 0;
  const auto hold = [&](timing::EventId z, std::uint64_t fired) {
    if (bounds.occurrences().timeout_never_fires(z) || !certain.times_out(z)) return;
    EXPECT_GT(fired, 0U) << "channel " << events[z].channel;
    ++count;
  };
  for (std::uint32_t c = 0; c < seen.net().channels.size(); ++c) {
    if (seen.net().channels[c].send_blocks) hold(events.acked(c), seen.send_timeouts[c]);
    if (seen.net().channels[c].receive_blocks) hold(events.read(c), seen.receive_timeouts[c]);
  }
  return count;
}

/// A command is given when the last transition function ends. The runtime tells when it begins, so that the least
/// time of a call is added.
void hold_chains(const Observed& seen, const Bounds& bounds) {
  for (std::size_t chain = 0; chain < seen.drawn.chains.size(); ++chain) {
    const ChainBound bound = bounds.chain(timing::chain_of(seen.drawn.chains[chain]));
    const timing::Time least = seen.least_time_of(seen.last_of(chain));
    const std::vector<Command>& commands = seen.commands[chain];
    std::int64_t age = 0, reaction = 0;
    for (const Command& command : commands) age = std::max(age, command.given - command.sampled);
    std::size_t at = 0;
    for (const std::int64_t sample : seen.samples[chain]) {
      while (at < commands.size() && commands[at].sampled <= sample) ++at;
      if (at == commands.size()) break;
      reaction = std::max(reaction, commands[at].given - sample);
    }
    hold("age of chain", chain, age + least * tick_ns, bound.age);
    hold("reaction of chain", chain, reaction + least * tick_ns, bound.reaction);
  }
}

/// Whether a chain uses a channel twice, whose values would then come from two places.
bool repeats(const ::timing::Chain& chain) {
  for (auto one = chain.begin(); one != chain.end(); ++one)
    if (std::find(std::next(one), chain.end(), *one) != chain.end()) return true;
  return false;
}

std::uint64_t systems_asked(std::uint64_t usual) {
  const char* const asked = std::getenv("TESSERA_TIMING_RUNS");
  return asked == nullptr ? usual : std::strtoull(asked, nullptr, 10);
}

/// The events in the runs of many systems.
struct Total {
  std::uint64_t commands = 0, must_fire = 0;
};

/// Runs the system, and holds what it shows against its bounds.
void try_out(::timing::Case drawn, std::uint64_t seed, Total& total) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  Observed seen;
  seen.drawn = std::move(drawn);
  seen.longest = seed % 3 == 0;
  seen.drawn.net.latency = 0;  // the simulated clock has none
  std::erase_if(seen.drawn.chains, repeats);
  if (seen.drawn.chains.size() > most_chains) seen.drawn.chains.resize(most_chains);
  const timing::System system = timing::system_of(seen.net());
  const Bounds bounds(system);
  ::timing::Tick until = 30;
  for (const ::timing::Subsystem& one : seen.net().subsystems)
    until = std::max({until, one.period, one.wcet});
  until *= 40;
  const timing::Time all = timing::pattern_of_all(bounds, timing::longest_pattern);
  const bool is_long_enough = all < timing::longest_pattern;
  if (is_long_enough) until += 3 * all;
  ASSERT_TRUE(run(seen, seed, until, seed % 2 == 0));
  hold_subsystems(seen, bounds);
  hold_timeouts(seen, bounds.occurrences());
  if (is_long_enough) total.must_fire += hold_certain(seen, bounds);
  hold_chains(seen, bounds);
  for (const std::vector<Command>& of_chain : seen.commands) total.commands += of_chain.size();
}

// TESSERA_TIMING_RUNS=20000 runs so many systems.
TEST(Runtime, ExceedsNoBound) {
  using ::timing::Family;
  constexpr std::array families{Family::any, Family::periodic, Family::driven, Family::blocking,
                                Family::ring};
  Total total;
  const std::uint64_t systems = systems_asked(2000);
  for (std::uint64_t seed = 1; seed <= systems && !HasFailure(); ++seed)
    try_out(::timing::draw(seed, families[seed % families.size()]), seed, total);
  EXPECT_GT(total.commands, systems);
  EXPECT_GT(total.must_fire, systems / 50);
}

TEST(Runtime, ExceedsNoBoundOfOtherShapes) {
  Total total;
  const std::uint64_t systems = systems_asked(900);
  for (std::uint64_t seed = 1; seed <= systems && !HasFailure(); ++seed) {
    ::timing::Case drawn = timing::draw_shape(seed, {});
    for (::timing::Subsystem& one : drawn.net.subsystems) one.cpu = -1;  // the simulated clock knows none
    try_out(std::move(drawn), seed, total);
  }
  EXPECT_GT(total.commands, systems);
  EXPECT_GT(total.must_fire, systems / 50);
}

/// The run in the times of the runtime.
timing::WorstRun in_ns(timing::WorstRun run) {
  for (timing::CallOfRun& call : run.calls)
    for (timing::Time* const time : {&call.begin, &call.end, &call.late}) *time *= tick_ns;
  run.from *= tick_ns;
  run.to *= tick_ns;
  return run;
}

/// The runtime gives the command of the run, and none that is based on a later reading comes before it.
void expect_same(const Observed& seen, std::size_t chain, const timing::WorstRun& run, bool is_age) {
  timing::Time begin = -1;
  for (const timing::CallOfRun& call : run.calls)
    if (begin < 0 && call.subsystem == seen.last_of(chain) && call.end == run.to) begin = call.begin;
  const std::vector<Command>& commands = seen.commands[chain];
  const auto given = std::ranges::find(commands, begin, &Command::given);
  ASSERT_NE(given, commands.end()) << "no command begins at " << begin;
  if (is_age) {
    EXPECT_EQ(given->sampled, run.from);
    return;
  }
  EXPECT_GT(given->sampled, run.from);
  const auto newer =
      std::ranges::find_if(commands, [&](const Command& command) { return command.sampled > run.from; });
  EXPECT_EQ(newer, given);
}

double median_of(std::vector<double>& values) {
  if (values.empty()) return 0;
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

// TESSERA_WORST_RUNS=2000 searches in so many systems.
TEST(Runtime, MakesTheWorstRunsAgain) {
  const char* const asked = std::getenv("TESSERA_WORST_RUNS");
  const std::uint64_t systems = asked == nullptr ? 120 : std::strtoull(asked, nullptr, 10);
  using ::timing::Family;
  constexpr std::array families{Family::any,      Family::periodic, Family::driven,
                                Family::blocking, Family::ring,     Family::shared};
  std::vector<double> ages, enumerated;
  std::uint64_t made = 0, exact = 0, exact_reached = 0;
  for (std::uint64_t seed = 1; seed <= systems && !HasFailure(); ++seed) {
    Observed seen;
    seen.drawn = ::timing::draw(seed, families[seed % families.size()]);
    seen.drawn.net.latency = 0;  // the simulated clock has none
    std::erase_if(seen.drawn.chains, repeats);
    if (seen.drawn.chains.empty()) continue;
    seen.drawn.chains.resize(1);
    timing::Declared declared;
    declared.system = timing::system_of(seen.net());
    const std::size_t count = declared.system.subsystems.size();
    declared.missing.resize(count);
    declared.differ.resize(count);
    declared.takes_turns.resize(count);
    const Bounds bounds(declared.system);
    const timing::Chain chain = timing::chain_of(seen.drawn.chains[0]);
    const ChainBound bound = bounds.chain(chain);
    timing::WorstRunSearch search(declared, bounds, {}, {.of_one = 150'000});
    const timing::WorstRuns found = search.find(chain);
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const auto& [run, most, is_age] :
         {std::tuple(found.age, bound.age, true), std::tuple(found.reaction, bound.reaction, false)}) {
      if (!run) continue;
      EXPECT_LE(run->time(), most);
      EXPECT_EQ(run->reaches, run->time() == most);
      const double share = static_cast<double>(run->time()) / static_cast<double>(most);
      if (is_age) ages.push_back(share);
      if (bound.enumerated) enumerated.push_back(share);
      if (seed % families.size() == 1 && bound.enumerated) {
        ++exact;
        exact_reached += run->reaches ? 1 : 0;
      }
      if (!run->on_simulated_clock) continue;
      ++made;
      Observed again;
      again.drawn = seen.drawn;
      const timing::WorstRun told = in_ns(*run);
      ASSERT_TRUE(tessera::timing_test::run(again, seed, run->to + 1, false,
                                            scenario_json(told, {"drawn", is_age}, [](std::uint32_t i) {
                                              return "a" + std::to_string(i) + ".control";
                                            })));
      expect_same(again, 0, told, is_age);
      if (HasFailure()) return;
    }
  }
  std::printf(
      "%zu ages: median %.3f of the bound; %zu enumerated: %.3f; periodic reached %llu of %llu; made again "
      "%llu\n",
      ages.size(), median_of(ages), enumerated.size(), median_of(enumerated),
      static_cast<unsigned long long>(exact_reached), static_cast<unsigned long long>(exact),
      static_cast<unsigned long long>(made));
  EXPECT_GE(made, systems);
  EXPECT_GE(median_of(ages), 0.85);
  EXPECT_GE(median_of(enumerated), 0.95);
}

}  // namespace
}  // namespace tessera::timing_test
