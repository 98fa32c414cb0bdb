#include "run/schedules.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "system/console.hpp"
#include "system/stop_signals.hpp"
#include "system/waker.hpp"

namespace tessera {
namespace {

constexpr std::int64_t schedules_progress_period_ns = 200'000'000;

/// Turns the output of the runs off while it exists.
class Quiet {
 public:
  Quiet() { console::silence(true); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  ~Quiet() { console::silence(false); }
};

[[nodiscard]] double seconds_since(std::int64_t start_ns) {
  return static_cast<double>(monotonic_ns() - start_ns) * 1e-9;
}

void show_progress(const ScheduleReport& report) {
  console::progress(fmt::format("{} of {} schedules, {:.0f} a second", report.tried, report.asked,
                                static_cast<double>(report.tried) / report.wall_s));
}

}  // namespace

std::optional<ScheduleReport> try_schedules(const System& system, RunOptions options, std::uint64_t count,
                                            std::string& error) {
  if (!options.hardware.empty()) {
    error = "schedules cannot be tried with hardware in the loop";
    return std::nullopt;
  }
  ScheduleReport report;
  report.first_seed = options.seed;
  report.asked = count;
  const bool progress = std::exchange(options.progress, false);
  options.interleave = true;
  options.recording.clear();
  if (options.world) options.world->trace.clear();
  const Quiet quiet;
  const StopSignals signals;
  const std::int64_t start_ns = monotonic_ns();
  for (std::int64_t shown_ns = start_ns; report.tried < count && report.interrupted == 0 && !report.failed;) {
    options.seed = report.first_seed + report.tried;
    if (options.world) options.world->seed = options.seed;
    std::optional<RunSummary> summary = execute(system, options, error);
    if (!summary) return std::nullopt;
    report.simulated += summary->simulated;
    report.firings += summary->firings;
    report.interrupted = summary->signal;
    report.wall_s = seconds_since(start_ns);
    if (report.interrupted == 0) ++report.tried;
    if (summary->failed) report.failed = {options.seed, std::move(*summary)};
    if (!progress || monotonic_ns() - shown_ns < schedules_progress_period_ns) continue;
    shown_ns = monotonic_ns();
    show_progress(report);
  }
  console::clear_progress();
  return report;
}

std::string schedules_line(const ScheduleReport& report) {
  const std::string effort = fmt::format("{:.1f} s simulated in {:.2f} s, {} firings",
                                         seconds(report.simulated), report.wall_s, report.firings);
  if (report.failed)
    return fmt::format("seed {} fails at {:.6f} s: {}\n  (schedule {} of {}; {})\n", report.failed->seed,
                       seconds(report.failed->summary.simulated), report.failed->summary.ended, report.tried,
                       report.asked, effort);
  return fmt::format("{} of {} schedules from seed {} on, none fails ({}){}\n", report.tried, report.asked,
                     report.first_seed, effort, report.interrupted == 0 ? "" : "; interrupted");
}

std::string schedules_json(const ScheduleReport& report) {
  nlohmann::ordered_json json{{"asked", report.asked},
                              {"tried", report.tried},
                              {"first_seed", report.first_seed},
                              {"simulated_s", seconds(report.simulated)},
                              {"wall_s", report.wall_s},
                              {"firings", report.firings},
                              {"interrupted", report.interrupted != 0},
                              {"failure", nullptr}};
  if (report.failed)
    json["failure"] = {{"seed", report.failed->seed},
                       {"at_s", seconds(report.failed->summary.simulated)},
                       {"ended", report.failed->summary.ended}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace tessera
