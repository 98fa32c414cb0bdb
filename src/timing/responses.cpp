#include "timing/responses.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace tessera::timing {
namespace {

/// The calls of a subsystem may become ready as often as the releases of `period` in a window, and `more` times.
struct Arrivals {
  Time period = 0;
  Time more = 0;
};

class Responses {
 public:
  Responses(const System& system, const StopAsked& stop) : system_(system), stop_(stop) {
    for (std::uint32_t i = 0; i < system.subsystems.size(); ++i)
      if (const int processor = system.subsystems[i].processor; processor >= 0)
        sharing_[processor].push_back(i);
  }

  [[nodiscard]] Response of(std::uint32_t i) {
    const Subsystem& subsystem = system_.subsystems[i];
    if (subsystem.processor < 0) return {subsystem.longest, 0};
    const std::vector<std::uint32_t>& all = sharing_.at(subsystem.processor);
    const bool equals = std::ranges::any_of(
        all, [&](std::uint32_t j) { return j != i && system_.subsystems[j].priority == subsystem.priority; });
    return {equals ? smallest_window(i, 0, true) : smallest_window(i, subsystem.longest, false),
            minus(smallest_window(i, 1, equals), 1)};
  }

 private:
  /// How often the calls of i may become ready: each of them is a lower bound of its own, so the least counts.
  /// Each iteration of a subsystem with a strict receive takes a value. All but two of these are written in the
  /// window: one may be there already, and one may be in use.
  const std::vector<Arrivals>& arrivals_of(std::uint32_t i) {
    const auto [at, is_new] = arrivals_.try_emplace(i);
    if (!is_new) return at->second;
    std::vector<std::uint32_t> level{i};
    std::vector<bool> seen(system_.subsystems.size());
    seen[i] = true;
    for (Time more = 0; !level.empty(); more += 2) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t j : level) {
        const Subsystem& subsystem = system_.subsystems[j];
        if (subsystem.period > 0 && !subsystem.catch_up) {
          at->second.push_back({subsystem.period, more});
          continue;
        }
        for (const std::uint32_t c : subsystem.receives) {
          const Channel& channel = system_.channels[c];
          if (!channel.receive_blocks || channel.receive_timeout > 0 || seen[channel.from]) continue;
          seen[channel.from] = true;
          next.push_back(channel.from);
        }
      }
      level = std::move(next);
    }
    return at->second;
  }
  Time calls_within(std::uint32_t i, Time window) {
    Time least = unbounded;
    for (const Arrivals& one : arrivals_of(i))
      least = std::min(least, ceil_div(window + system_.latency, one.period) + one.more);
    return least;
  }

  /// The smallest window in which `own` and all calls that may go first are done.
  /// with_itself: also calls of i, which those before have left behind.
  Time smallest_window(std::uint32_t i, Time own, bool with_itself) {
    constexpr int most_steps = 100'000;
    const Subsystem& subsystem = system_.subsystems[i];
    Time window = std::max<Time>(own, 1);
    for (int step = 0; step < most_steps; ++step) {
      check(stop_);
      Time next = own;
      for (const std::uint32_t j : sharing_.at(subsystem.processor)) {
        const Subsystem& other = system_.subsystems[j];
        if (other.priority < subsystem.priority || (j == i && !with_itself)) continue;
        const Time count = calls_within(j, window);
        if (count > 0 && count >= unbounded / other.longest) return unbounded;
        next = plus(next, count * other.longest);
      }
      if (next <= window || next >= unbounded) return std::max(next >= unbounded ? unbounded : window, own);
      window = next;
    }
    return unbounded;
  }

  const System& system_;
  const StopAsked& stop_;
  std::map<int, std::vector<std::uint32_t>> sharing_;
  std::map<std::uint32_t, std::vector<Arrivals>> arrivals_;
};

}  // namespace

std::vector<Response> responses_of(const System& system, const StopAsked& stop) {
  Responses responses(system, stop);
  std::vector<Response> result;
  result.reserve(system.subsystems.size());
  for (std::uint32_t i = 0; i < system.subsystems.size(); ++i) result.push_back(responses.of(i));
  return result;
}

}  // namespace tessera::timing
