#include "timing/conduct/drift.hpp"

#include <algorithm>
#include <numeric>

namespace tessera::timing {
namespace {

constexpr Time second = 1'000'000'000, microsecond = 1'000;

/// When all of them come together again; unbounded: after more iterations than are followed.
Time together(const std::vector<Time>& periods) {
  if (periods.empty()) return 1;
  const Time longest = *std::ranges::min_element(periods) * (Clocked::most_iterations / 4);
  Time all = 1;
  for (const Time period : periods) {
    const Time factor = period / std::gcd(all, period);
    if (factor > longest / all) return unbounded;
    all *= factor;
  }
  return all;
}

std::vector<Time> without(std::vector<Time> periods, Time period) {
  std::erase(periods, period);
  return periods;
}

/// Periods near the given one that divide the time in which the others come together, or are a multiple of it.
std::vector<Time> near(Time period, Time others) {
  const auto is_plain = [](Time one) { return second % one == 0 || one % microsecond == 0; };
  std::vector<Time> found;
  for (Time parts = ceil_div(others, period); parts <= 4 * ceil_div(others, period); ++parts)
    if (others % parts == 0 && is_plain(others / parts)) {
      found.push_back(others / parts);
      break;
    }
  if (period > others) found.push_back((period / others + 1) * others);
  for (Time parts = others / period; parts > 0; --parts)
    if (others % parts == 0 && is_plain(others / parts)) {
      found.push_back(others / parts);
      break;
    }
  return found;
}

}  // namespace

std::optional<Drift> drift_of(const Bounds& bounds, const Chain& chain) {
  const System& system = bounds.occurrences().system();
  std::vector<std::uint32_t> path{system.channels[chain.front()].from};
  for (const std::uint32_t c : chain) {
    // Over networks and foreign nodes there are sums whatever the rates are.
    if (system.crosses(c) || system.channels[c].from != path.back()) return std::nullopt;
    if (!bounds.occurrences().keeps_values(c)) return std::nullopt;
    path.push_back(system.channels[c].to);
  }
  if (!bounds.clocked().knows(path.front())) return std::nullopt;
  std::vector<Time> periods;
  for (const std::uint32_t i : path)
    if (system.subsystems[i].period > 0) periods.push_back(system.subsystems[i].period);
  if (together(periods) < unbounded || bounds.chain(chain).enumerated) return std::nullopt;
  // Best a rate that is no whole number of nanoseconds: 30 Hz.
  std::stable_partition(path.begin(), path.end(), [&](std::uint32_t i) {
    const Time period = system.subsystems[i].period;
    return period > 0 && second % period != 0 && period % microsecond != 0;
  });
  for (const std::uint32_t i : path) {
    const Time period = system.subsystems[i].period;
    if (period == 0) continue;
    const Time others = together(without(periods, period));
    if (others < unbounded && others > 1) return Drift{i, period, near(period, others)};
  }
  return Drift{path.front(), system.subsystems[path.front()].period, {}};
}

}  // namespace tessera::timing
