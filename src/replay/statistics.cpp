#include "replay/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "tessera/transition_role.hpp"

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

class Counting {
 public:
  explicit Counting(std::string path) { statistics_.path = std::move(path); }

  void fire(const Recording::Transition& transition, std::int64_t at_ns) {
    ++statistics_.firings;
    const TransitionRole& role = transition.role;
    of_iteration(role, at_ns);
    if (role.communicates()) {
      if (last_) waits_[local(transition.name)].push_back(seconds(at_ns - *last_));
      statistics_.timeouts += static_cast<std::uint64_t>(role.step == Step::timeout);
      statistics_.skips += static_cast<std::uint64_t>(role.step == Step::skip);
      statistics_.overwrites += static_cast<std::uint64_t>(role.step == Step::overwrite);
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
  /// As it is shown: without the path of the subsystem.
  [[nodiscard]] std::string local(const std::string& name) const {
    return name.starts_with(statistics_.path + '.') ? name.substr(statistics_.path.size() + 1) : name;
  }

  void of_iteration(const TransitionRole& role, std::int64_t at_ns) {
    if (role.step == Step::begin_sending) {
      ++statistics_.iterations;
      if (called_) calls_.push_back(seconds(at_ns - *std::exchange(called_, std::nullopt)));
      if (begun_) periods_.push_back(seconds(at_ns - *begun_));
      begun_ = at_ns;
    }
    communicate(role, at_ns);
    statistics_.errors += static_cast<std::uint64_t>(role.step == Step::error);
  }

  /// Sending and receiving follow one another, or, if the subsystem receives first, the transition function
  /// is between them.
  void communicate(const TransitionRole& role, std::int64_t at_ns) {
    if (role.step == Step::begin_sending || role.step == Step::begin_receiving) {
      if (!communicates_since_) communicates_since_ = at_ns;
    } else if (role.step == Step::end_receiving || role.ends_iteration()) {
      if (communicates_since_) communicated_ += at_ns - *communicates_since_;
      communicates_since_.reset();
      if (!role.ends_iteration()) return;
      if (whole_) iterations_.push_back(seconds(communicated_));
      communicated_ = 0;
    }
    // A recording may begin within an iteration.
    if (role.step == Step::start || role.ends_iteration()) whole_ = true;
  }

  SubsystemStatistics statistics_;
  std::vector<double> periods_, calls_, iterations_;
  std::map<std::string, std::vector<double>> waits_;
  std::optional<std::int64_t> last_, called_, begun_, communicates_since_;
  std::int64_t communicated_ = 0;  // in this iteration
  bool whole_ = false;             // its beginning is known
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
    counting[event.instance()].fire(recording.transitions[event.subject], event.time_ns);
  }
  std::vector<SubsystemStatistics> all;
  all.reserve(counting.size());
  for (Counting& one : counting) all.push_back(one.finish());
  return all;
}

}  // namespace tessera::replay
