#include "replay/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

namespace tessera::replay {
namespace {

constexpr std::size_t histogram_steps = 24;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

double quantile(std::vector<double>& values, double share) {
  const auto rank =
      static_cast<std::ptrdiff_t>(std::clamp(std::ceil(share * static_cast<double>(values.size())) - 1, 0.0,
                                             static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

Distribution distribution_of(std::vector<double> values) {
  Distribution result;
  result.count = values.size();
  if (values.empty()) return result;
  const auto [least, most] = std::ranges::minmax(values);
  result.least = least;
  result.most = most;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  if (most > least) {
    result.histogram.resize(histogram_steps);
    for (const double value : values) {
      const auto step = static_cast<std::size_t>((value - least) / (most - least) * histogram_steps);
      ++result.histogram[std::min(step, histogram_steps - 1)];
    }
  }
  result.median = quantile(values, 0.5);
  result.p99 = quantile(values, 0.99);
  return result;
}

/// "follow.t1" -> "t1"; empty unless the transition is of a behaviour itself, not of its communication.
std::string_view behaviour_transition(std::string_view local) {
  const std::size_t dot = local.find('.');
  if (dot == std::string_view::npos || local.find('.', dot + 1) != std::string_view::npos) return {};
  return local.substr(dot + 1);
}

/// "follow.snd.motion.t1" -> "t1"; empty for all others.
std::string_view communication_transition(std::string_view local) {
  const std::size_t first = local.find('.');
  if (first == std::string_view::npos) return {};
  const std::string_view rest = local.substr(first + 1);
  if (!rest.starts_with("snd.") && !rest.starts_with("rcv.")) return {};
  return rest.substr(rest.rfind('.') + 1);
}

class Counting {
 public:
  explicit Counting(std::string path) { statistics_.path = std::move(path); }

  void fire(std::string_view local, std::int64_t at_ns) {
    ++statistics_.firings;
    if (const std::string_view name = behaviour_transition(local); !name.empty()) of_behaviour(name, at_ns);
    if (const std::string_view name = communication_transition(local); !name.empty()) {
      if (last_) waits_[std::string(local)].push_back(seconds(at_ns - *last_));
      statistics_.timeouts += static_cast<std::uint64_t>(name == "timeout");
      statistics_.skips += static_cast<std::uint64_t>(name == "skip");
      statistics_.overwrites += static_cast<std::uint64_t>(name == "t1o");
    }
    last_ = at_ns;
  }

  void call(std::int64_t at_ns) { called_ = at_ns; }
  void overrun(std::uint32_t missed) { statistics_.overruns += missed; }
  void fault() { ++statistics_.faults; }

  SubsystemStatistics finish() {
    statistics_.period = distribution_of(std::move(periods_));
    statistics_.call = distribution_of(std::move(calls_));
    statistics_.iteration = distribution_of(std::move(iterations_));
    for (auto& [name, times] : waits_) statistics_.waits.push_back({name, distribution_of(std::move(times))});
    std::ranges::stable_sort(statistics_.waits, std::greater<>(),
                             [](const auto& wait) { return wait.time.mean; });
    return std::move(statistics_);
  }

 private:
  void of_behaviour(std::string_view name, std::int64_t at_ns) {
    if (name == "t1") {
      ++statistics_.iterations;
      if (called_) calls_.push_back(seconds(at_ns - *std::exchange(called_, std::nullopt)));
      if (begun_) periods_.push_back(seconds(at_ns - *begun_));
      begun_ = at_ns;
      open_ = true;
    }
    if (open_ && (name == "t4" || name == "t5" || name == "t6")) {
      iterations_.push_back(seconds(at_ns - *begun_));
      open_ = false;
    }
    statistics_.errors += static_cast<std::uint64_t>(name == "t6");
  }

  SubsystemStatistics statistics_;
  std::vector<double> periods_, calls_, iterations_;
  std::map<std::string, std::vector<double>> waits_;
  std::optional<std::int64_t> last_, called_, begun_;
  bool open_ = false;
};

}  // namespace

std::vector<SubsystemStatistics> statistics_of(const Recording& recording) {
  std::vector<Counting> counting;
  for (const std::string& path : recording.instances) counting.emplace_back(path);
  for (const auto& [event, text] : recording.entries) {
    if (event.instance() >= counting.size()) continue;
    if (event.kind() == Event::Kind::overrun) counting[event.instance()].overrun(event.subject);
    if (event.kind() == Event::Kind::call) counting[event.instance()].call(event.time_ns);
    if (event.kind() == Event::Kind::fault) counting[event.instance()].fault();
    if (event.kind() != Event::Kind::firing) continue;
    std::string_view name = recording.transitions[event.subject].name;
    const std::string& path = recording.instances[event.instance()];
    if (name.starts_with(path) && name.size() > path.size()) name.remove_prefix(path.size() + 1);
    counting[event.instance()].fire(name, event.time_ns);
  }
  std::vector<SubsystemStatistics> all;
  all.reserve(counting.size());
  for (Counting& one : counting) all.push_back(one.finish());
  return all;
}

}  // namespace tessera::replay
