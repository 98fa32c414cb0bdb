#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tessera/controller.hpp"
#include "tessera/sample_counts.hpp"

namespace tessera {

/// Seeds that follow one another: begin, begin + 1, ..., end - 1.
struct SeedRange {
  std::uint64_t begin = 0, end = 0;
  bool operator==(const SeedRange&) const = default;
};

/// A fault or failure in one run: its kind, and where it happened.
struct ScheduleEvent {
  std::string kind;  ///< "assertion", "deadlock", ...: one of schedule_event_kinds
  std::string name;  ///< the subsystem, or the check of the system; empty: neither
  double at_s = 0;   ///< time of the first one in the run; NaN: not known
  std::string text;
};

/// The result of one run among many.
struct ScheduleResult {
  std::uint64_t seed = 0;
  bool failed = false;
  bool interrupted = false;  ///< a signal has ended the run
  Duration simulated{};
  std::uint64_t firings = 0;
  std::string ended;                  ///< as RunSummary::ended
  std::vector<ScheduleEvent> events;  ///< each kind and name once; a run that failed has at least one
  /// The planted faults. Empty: there are none, or the run died and nobody knows.
  std::vector<RunSummary::PlantedFault> injected{};
  bool ended_by_itself = false;  ///< the net has ended, or user code has stopped the run
  struct Used {
    std::string resource, unit;
    double amount = 0;
  };
  std::vector<Used> used{};        ///< by all agents together
  bool only_check_failed = false;  ///< the run went on to its end, but a check of it failed
};

/// The frequency of one kind of fault or failure.
struct ScheduleOutcome {
  std::uint64_t runs = 0;    ///< runs in which it happened
  std::uint64_t failed = 0;  ///< runs among them that failed; in the others, the controller went on
  std::uint64_t first_seed = 0;
  double at_s = 0;  ///< time in the run of the first seed
  std::string text;
};

/// The number of runs with a planted fault. A run that died counts in neither number.
struct InjectionCount {
  std::uint64_t runs = 0;    ///< runs in which it happened
  std::uint64_t missed = 0;  ///< runs that have ended without it
};

/// The kinds of faults and failures, in the order of the table.
[[nodiscard]] const std::vector<std::string>& schedule_event_kinds();

/// The result of trying many schedules.
struct ScheduleReport {
  std::string system, net_hash;
  std::uint64_t first_seed = 1, asked = 0;
  std::uint64_t tried = 0;    ///< completed runs
  std::uint64_t failed = 0;   ///< runs among them that failed
  unsigned jobs = 1;          ///< processes that ran at a time
  Duration simulated{};       ///< sum over all runs
  std::uint64_t firings = 0;  ///< sum over all runs
  double wall_s = 0;
  int interrupted = 0;  ///< the signal that ended the search; 0: none
  std::vector<SeedRange> ran;
  std::map<std::pair<std::string, std::string>, ScheduleOutcome> outcomes;  ///< by kind and name
  /// By kind alone; a run counts once, however many subsystems have the fault. All kinds are present.
  std::map<std::string, ScheduleOutcome> kinds;
  struct Failure {
    std::uint64_t seed;
    double at_s;
    std::string ended;
  };
  std::optional<Failure> first_failure;            ///< that of the lowest seed
  std::map<std::string, InjectionCount> injected;  ///< by the text of the planted fault
  /// Seeds reported as first whose run had another result when it was repeated alone in a process: user code
  /// keeps some state from run to run.
  std::vector<std::uint64_t> not_repeated;
  std::uint64_t ended_by_themselves = 0;      ///< before their duration was over, whatever their checks say
  std::uint64_t ended_with_failed_check = 0;  ///< runs among them of which a check failed
  /// A number of each run that went on to its end, whatever its checks say. The time is that of runs that have ended by themselves.
  struct Distribution {
    std::string name, unit;  ///< "time", "s"; "energy", "J"
    SampleCounts samples{};
  };
  std::vector<Distribution> distributions;
  /// Firings of each transition over all runs; empty: not counted.
  std::vector<std::pair<std::string, std::uint64_t>> transitions;

  ScheduleReport();
  void add(const ScheduleResult& result);
  void count(const std::string& name, const std::string& unit, double value, std::uint64_t seed);
  /// Checks that have not failed in any run get an outcome, too.
  void add_checks(const RunOptions& options);
};

/// A few lines for people.
[[nodiscard]] std::string schedules_text(const ScheduleReport& report);
/// `Schedules` in share/tessera/summary.schema.json.
[[nodiscard]] std::string schedules_json(const ScheduleReport& report);

/// Writes a result as one line of JSON, without line end; and reads it (nullopt: invalid).
[[nodiscard]] std::string to_line(const ScheduleResult& result);
[[nodiscard]] std::optional<ScheduleResult> from_line(std::string_view line);

}  // namespace tessera
