#include "run/schedules.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <exception>
#include <list>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "nets/flat_net.hpp"
#include "run/schedule_worker.hpp"
#include "system/console.hpp"
#include "system/stop_signals.hpp"
#include "system/waker.hpp"

namespace tessera {
namespace {

constexpr std::int64_t schedules_progress_period_ns = 200'000'000;
constexpr int between_looks_at_workers_ms = 100;
/// After this number of deaths, further processes are quiet, because their messages are the same.
constexpr std::uint64_t deaths_to_be_heard = 4;
constexpr std::size_t most_repeated = 16;
constexpr const char* cannot_start = "no start";

[[nodiscard]] unsigned usable_cores() {
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) != 0) return 1;
  return static_cast<unsigned>(std::max(1, CPU_COUNT(&cores)));
}

[[nodiscard]] std::string time_left_text(double left_s) {
  if (left_s < 60) return fmt::format("{:.0f} s", left_s);
  if (left_s < 3600) return fmt::format("{:.0f} min", left_s / 60);
  return fmt::format("{:.1f} h", left_s / 3600);
}

/// The runs of one call, and the processes that make them.
class Schedules {
 public:
  /// options: of each run. parent: ends everything with its end; 0: none.
  Schedules(const System& system, const RunOptions& options, const ScheduleRequest& request, int parent,
            bool progress)
      : options_(options),
        parent_(parent),
        jobs_(jobs_of(request, options)),
        net_(request.coverage ? net_of(system) : FlatNet{}),
        firings_(net_.transitions.size() * jobs_),
        seeds_(options.seed, request.count, jobs_),
        system_(system),
        progress_(progress) {
    report_.system = system.name;
    report_.net_hash = system.net_hash;
    report_.first_seed = options.seed;
    report_.asked = request.count;
    report_.jobs = jobs_;
  }

  /// Discards standard error of the processes.
  void be_quiet() { deaths_ = deaths_to_be_heard; }

  /// nullopt and `error`: no run can start.
  [[nodiscard]] std::optional<ScheduleReport> run(std::string& error) {
    for (unsigned number = 0; number < jobs_; ++number) start(number);
    while (!workers_.empty() && error.empty()) {
      wait();
      pass_signals_on();
      for (auto worker = workers_.begin(); worker != workers_.end();) worker = hear(worker, error);
      show_progress();
    }
    console::clear_progress();
    if (!error.empty()) return std::nullopt;
    report_.interrupted = StopSignals::pending();
    report_.wall_s = wall_s();
    for (std::size_t index = 0; index < net_.transitions.size(); ++index) {
      std::uint64_t firings = 0;
      for (unsigned number = 0; number < jobs_; ++number) firings += counters(number)[index];
      report_.transitions.emplace_back(net_.transitions[index].name, firings);
    }
    return std::move(report_);
  }

 private:
  /// A simulator that is a server simulates one run at a time.
  [[nodiscard]] static unsigned jobs_of(const ScheduleRequest& request, const RunOptions& options) {
    if (options.world && options.world->server) return 1;
    const unsigned wanted = request.jobs == 0 ? usable_cores() : request.jobs;
    return static_cast<unsigned>(
        std::clamp<std::uint64_t>(wanted, 1, std::max<std::uint64_t>(1, request.count)));
  }

  [[nodiscard]] std::span<std::uint64_t> counters(unsigned number) const {
    const std::size_t count = net_.transitions.size();
    return firings_.all().subspan(number * count, count);
  }

  [[nodiscard]] double wall_s() const { return static_cast<double>(monotonic_ns() - start_ns_) * 1e-9; }

  void start(unsigned number) {
    if (seeds_.empty() || StopSignals::pending() != 0) return;
    workers_.emplace_back(
        ScheduleWorker::Task{system_, options_, seeds_, counters(number), deaths_ >= deaths_to_be_heard},
        number);
  }

  void wait() const {
    std::vector<pollfd> outputs;
    for (const ScheduleWorker& worker : workers_)
      outputs.push_back({.fd = worker.descriptor(), .events = POLLIN, .revents = 0});
    poll(outputs.data(), outputs.size(), between_looks_at_workers_ms);
  }

  /// A signal of the terminal reaches all processes, another one only this process.
  void pass_signals_on() {
    if (parent_ != 0 && StopSignals::pending() == 0 && getppid() != parent_) kill(getpid(), SIGTERM);
    const int signal = StopSignals::pending();
    if (signal == 0 || std::exchange(passed_on_, signal) != 0) return;
    for (const ScheduleWorker& worker : workers_) worker.signal(signal);
  }

  using Workers = std::list<ScheduleWorker>;
  Workers::iterator hear(Workers::iterator worker, std::string& error) {
    ScheduleWorker::News news = worker->read();
    for (ScheduleResult& result : news.results) hear_result(worker->number(), std::move(result));
    for (auto& [seed, why] : news.refusals) hear_refusal(worker->number(), seed, std::move(why), error);
    if (!news.ended) return std::next(worker);
    const unsigned number = worker->number();
    const std::string death = worker->death();
    worker = workers_.erase(worker);
    if (!death.empty() && StopSignals::pending() == 0) hear_death(number, death);
    if (error.empty()) start(number);
    return worker;
  }

  void hear_result(unsigned number, ScheduleResult result) {
    heard_[number] = result.seed;
    if (result.interrupted && StopSignals::pending() != 0) return;  // it is not complete
    if (result.interrupted && !plants_signals()) {                  // this one process was stopped from
                                                                    // outside
      result.failed = true;
      result.events.push_back({.kind = "other", .name = "", .at_s = 0, .text = result.ended});
    }
    report_.add(result);
  }

  [[nodiscard]] bool plants_signals() const {
    return std::ranges::any_of(options_.inject,
                               [](const std::string& fault) { return fault.starts_with("signal:"); });
  }

  /// If the first run that reports cannot start, no run can. Later, only this seed is affected.
  void hear_refusal(unsigned number, std::uint64_t seed, std::string why, std::string& error) {
    heard_[number] = seed;
    if (StopSignals::pending() != 0) return;  // it was asked to stop while it opened its devices
    if (report_.tried == 0)
      error = std::move(why);
    else
      add_failure(seed, cannot_start, std::move(why));
  }

  void hear_death(unsigned number, const std::string& death) {
    ++deaths_;
    const auto seed = seeds_.taken_by(number);
    if (seed && heard_[number] != seed) add_failure(*seed, "crash", death);
  }

  void add_failure(std::uint64_t seed, const char* kind, std::string what) {
    ScheduleResult result{.seed = seed,
                          .failed = true,
                          .interrupted = false,
                          .simulated = {},
                          .firings = 0,
                          .ended = what,
                          .events = {}};
    result.events.push_back({.kind = kind, .name = "", .at_s = NAN, .text = std::move(what)});
    report_.add(result);
  }

  void show_progress() {
    if (!progress_ || monotonic_ns() - shown_ns_ < schedules_progress_period_ns) return;
    shown_ns_ = monotonic_ns();
    const double rate = static_cast<double>(report_.tried) / wall_s();
    std::string text = fmt::format("{} of {} schedules, {:.0f} a second", report_.tried, report_.asked, rate);
    if (report_.failed > 0) text += fmt::format(", {} failed", report_.failed);
    if (rate > 0)
      text +=
          fmt::format(", {} left", time_left_text(static_cast<double>(report_.asked - report_.tried) / rate));
    console::progress(text);
  }

  const RunOptions& options_;
  int parent_;
  unsigned jobs_;
  FlatNet net_;  // only for coverage
  SharedCounters firings_;
  SeedQueue seeds_;
  const System& system_;
  bool progress_;
  ScheduleReport report_;
  std::map<unsigned, std::optional<std::uint64_t>> heard_;  // per number of a worker: the seed of its last
                                                            // report
  std::uint64_t deaths_ = 0;
  int passed_on_ = 0;
  std::int64_t start_ns_ = monotonic_ns(), shown_ns_ = start_ns_;
  Workers workers_;
};

/// The seeds that the report names first and whose run differs when a process makes only that run.
[[nodiscard]] std::vector<std::uint64_t> not_repeated(const ScheduleReport& report, const System& system,
                                                      RunOptions options, int parent) {
  std::set<std::uint64_t> seeds;
  if (report.first_failure) seeds.insert(report.first_failure->seed);
  for (const auto& [key, outcome] : report.outcomes) seeds.insert(outcome.first_seed);
  std::vector<std::uint64_t> otherwise;
  std::size_t repeated = 0;
  for (const std::uint64_t seed : seeds) {
    if (repeated++ == most_repeated || StopSignals::pending() != 0) break;
    options.seed = seed;
    Schedules alone(system, options, {.count = 1, .jobs = 1}, parent, /*progress=*/false);
    alone.be_quiet();
    std::string error;
    const std::optional<ScheduleReport> again = alone.run(error);
    if (StopSignals::pending() != 0) break;
    const bool same_events = std::ranges::all_of(report.outcomes, [&](const auto& outcome) {
      if (outcome.second.first_seed != seed) return true;
      return again ? again->outcomes.contains(outcome.first) : outcome.first.first == cannot_start;
    });
    const bool same_end =
        !again || !report.first_failure || report.first_failure->seed != seed ||
        (again->first_failure && again->first_failure->ended == report.first_failure->ended);
    if (!same_events || !same_end) otherwise.push_back(seed);
  }
  return otherwise;
}

}  // namespace

std::optional<ScheduleReport> try_schedules(const System& system, RunOptions options,
                                            const ScheduleRequest& request, std::string& error) try {
  if (!options.hardware.empty()) {
    error = "schedules cannot be tried with hardware in the loop";
    return std::nullopt;
  }
  if (request.count > 0 && options.seed + (request.count - 1) < options.seed) {
    error = "there are not so many seeds: the last one would be beyond 2^64";
    return std::nullopt;
  }
  const bool progress = std::exchange(options.progress, false);
  options.interleave = true;
  options.recording.clear();
  if (options.world) options.world->trace.clear();
  const int parent = std::exchange(options.parent, 0);
  const StopSignals signals;
  std::optional<ScheduleReport> report = Schedules(system, options, request, parent, progress).run(error);
  if (report && report->interrupted == 0)
    report->not_repeated = not_repeated(*report, system, options, parent);
  if (report) report->add_checks(options);
  return report;
} catch (const std::exception& exception) {
  error = exception.what();
  return std::nullopt;
}

}  // namespace tessera
