// Bounds that are called exact: for each of them, a run is made that reaches it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "timing/bounds.hpp"

namespace tessera::timing {
namespace {

/// A chain of subsystems with rates, over channels at which nobody waits.
struct Line {
  System system;
  Chain chain;
};

Line draw(std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto in = [&](Time low, Time high) {
    return low + static_cast<Time>(engine() % static_cast<std::uint64_t>(high - low + 1));
  };
  Line line;
  const Time base = in(4, 25), kind = in(0, 2);
  const auto count = static_cast<std::uint32_t>(in(2, 6));
  for (std::uint32_t i = 0; i < count; ++i) {
    Subsystem& one = line.system.subsystems.emplace_back();
    one.period = kind == 0 ? base : kind == 1 ? base * in(1, 4) : in(4, 30);
    one.longest = in(1, one.period);
    one.shortest = in(0, 3) == 0 ? one.longest : in(1, one.longest);
    if (i > 0) one.receives = {i - 1};
    if (i + 1 == count) break;
    one.sends = {i};
    line.system.channels.push_back({i, i + 1});
    line.chain.push_back(i);
  }
  return line;
}

/// The times of single calls; the others are as short as they can be.
using Calls = std::vector<std::map<Time, Time>>;

/// The longest age and reaction of a run. At one instant, the later ones in the chain go first.
struct Run {
  Time age = 0, reaction = 0;

  Run(const System& system, const Calls& calls, Time until) {
    const auto count = static_cast<std::uint32_t>(system.subsystems.size());
    constexpr Time nothing = -1;
    std::vector<Time> written(count, nothing), held(count, nothing), used(count, nothing),
        iteration(count, 0);
    std::vector<Time> readings;
    std::vector<std::pair<Time, Time>> commands;  // when, and of which reading
    const auto finish = [&](std::uint32_t i) {
      const auto set = calls[i].find(iteration[i]);
      return iteration[i] * system.subsystems[i].period +
             (set == calls[i].end() ? system.subsystems[i].shortest : set->second);
    };
    for (;;) {
      std::uint32_t next = count - 1;
      for (std::uint32_t i = count; i-- > 0;)
        if (finish(i) < finish(next)) next = i;
      const Time now = finish(next);
      if (now > until) break;
      // The call uses the value that was received at the end of the iteration before.
      const Time value = next == 0 ? iteration[0] * system.subsystems[0].period : held[next];
      if (next == 0) readings.push_back(value);
      if (next + 1 == count) {
        if (value != nothing) commands.emplace_back(now, value);
      } else {
        written[next] = value;
      }
      if (next > 0) held[next] = written[next - 1];
      ++iteration[next];
    }
    for (const auto& [when, reading] : commands) age = std::max(age, when - reading);
    std::size_t at = 0;
    for (const Time reading : readings) {
      while (at < commands.size() && commands[at].second <= reading) ++at;
      if (at < commands.size()) reaction = std::max(reaction, commands[at].first - reading);
    }
  }
};

/// A call that should write late takes longest, and one that should look too early takes shortest.
Run worst_run(const System& system, Time bound, bool for_age) {
  const auto& all = system.subsystems;
  Time pattern = 1;
  for (const Subsystem& one : all) pattern = std::lcm(pattern, one.period);
  const Time settled = (bound / pattern + 1) * pattern;
  Calls best;
  Time worst = -1, until = 0;
  for (Time k = settled / all[0].period; k * all[0].period < settled + pattern; ++k) {
    Calls calls(all.size());
    Time newer = (k + 1) * all[0].period + all[0].longest;
    calls[0][k + 1] = all[0].longest;
    for (std::size_t i = 1; i < all.size(); ++i) {
      const Time missed = (newer - all[i].shortest) / all[i].period;
      const Time late = missed + (for_age && i + 1 == all.size() ? 1 : 2);
      calls[i][missed] = all[i].shortest;
      calls[i][late] = all[i].longest;
      newer = late * all[i].period + all[i].longest;
    }
    if (newer - k * all[0].period <= worst) continue;
    worst = newer - k * all[0].period;
    until = newer;
    best = std::move(calls);
  }
  return Run(system, best, until);
}

// TESSERA_TIMING_SYSTEMS=200000 tries so many.
TEST(Exact, SomeRunReachesEachBoundOfChainsWithoutWaits) {
  const char* const asked = std::getenv("TESSERA_TIMING_SYSTEMS");
  const std::uint64_t systems = asked == nullptr ? 500 : std::strtoull(asked, nullptr, 10);
  std::uint64_t reached = 0;
  for (std::uint64_t seed = 1; seed <= systems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Line line = draw(seed);
    const Bounds bounds(line.system);
    const ChainBound bound = bounds.chain(line.chain);
    if (!bound.enumerated) continue;
    ASSERT_EQ(worst_run(line.system, bound.reaction, true).age, bound.age);
    ASSERT_EQ(worst_run(line.system, bound.reaction, false).reaction, bound.reaction);
    ++reached;
  }
  EXPECT_GT(reached, systems / 2);
}

}  // namespace
}  // namespace tessera::timing
