// Random systems on the runtime, under the simulated clock and with `takes` as it draws it, beside their bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "drawn_run.hpp"
#include "drawn_shapes.hpp"
#include "timing/conduct/certain.hpp"

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

}  // namespace
}  // namespace tessera::timing_test
