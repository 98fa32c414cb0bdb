#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "statistics/seeds.hpp"
#include "tessera/result.hpp"
#include "tessera/sample_counts.hpp"

/// The results of many runs with different seeds, of one controller.
namespace tessera::statistics {

/// The frequency of a kind of failure: a class of faults, a broken check, a way in which runs fail.
struct Outcome {
  std::string kind;              ///< "assertion", "deadlock"
  std::string name;              ///< the subsystem or the check; empty: all of this kind
  std::uint64_t runs = 0;        ///< in which it happened, at least once
  std::uint64_t failed = 0;      ///< of these; in the others, the controller went on all the same
  std::uint64_t first_seed = 0;  ///< of the runs; the next two are of this run, too
  double at_s = 0;               ///< NaN: not known, null in JSON
  std::string text;
};

/// The number of runs with a fault of `--inject`. A run that died counts in neither number.
struct Injected {
  std::string fault;
  std::uint64_t runs = 0;    ///< in which it happened
  std::uint64_t missed = 0;  ///< that ended without it
};

/// A number of each run that has not failed: the time of those that have ended by themselves, or an amount that a run
/// has used.
struct Distribution {
  std::string name, unit;  ///< "time", "s"; "energy", "J"
  SampleCounts samples{};
};

/// The identity of the runs. Only results with the same identity can be counted together.
struct Identity {
  std::string system;
  std::string specification, net, controller;   ///< hashes
  std::map<std::string, std::string> settings;  ///< "for": "1s"; everything else that changes a run
};

struct Results {
  Identity identity;
  Seeds whole;                         ///< the seeds of all parts
  std::uint64_t parts = 1;             ///< into which the whole was divided
  std::vector<Seeds> ran;              ///< sorted, with gaps in between
  std::uint64_t tried = 0;             ///< runs that were completed
  std::uint64_t failed = 0;            ///< of these
  double simulated_s = 0, wall_s = 0;  ///< sums
  std::uint64_t firings = 0;
  bool interrupted = false;
  std::vector<Outcome> kinds;     ///< every kind there is, also those that never happened
  std::vector<Outcome> outcomes;  ///< by kind and name: those that happened, and checks that never failed
  struct Failure {
    std::uint64_t seed = 0;
    double at_s = 0;  ///< NaN: not known
    std::string ended;
  };
  std::optional<Failure> failure;    ///< the run of the lowest seed that failed
  std::vector<Injected> injected{};  ///< each fault of `--inject` once
  /// Runs that have ended before their duration was over, without a failure other than of a check. nullopt: results
  /// of an earlier version do not say it.
  std::optional<std::uint64_t> ended_by_themselves{};
  std::uint64_t ended_with_failed_check = 0;  ///< runs among them of which a check failed
  std::vector<Distribution> distributions{};
  /// First seeds whose runs had another result when they were made again, alone in a process.
  std::vector<std::uint64_t> not_repeated;
  std::string again;  ///< command that makes a run again, when the seed is put behind it
  /// Firings per transition of the net, over all runs; empty: not counted.
  std::map<std::string, std::uint64_t> transitions;
};

/// {"tessera": "schedules", "version": 1, "system", "specification", "net", "controller", "settings", "seeds":
/// [begin, end], "parts", "ran": [[begin, end]...], "tried", "failed", "interval": [low, high], "simulated_s",
/// "wall_s", "firings", "interrupted", "kinds", "outcomes", "failure": null or {"seed", "at_s", "ended"},
/// "not_repeated": [seed...], "again", "injected" (if there are faults): [{"fault", "runs", "missed"}...], "ended_by_themselves",
/// "ended_with_failed_check", "distributions": [{"name", "unit", "runs", "sum", "sum_of_squares", "least": {"value", "seed"}, "greatest", "classes":
/// [[class, runs]...]}...], "reproduce" (if a run failed), "transitions" (if counted)}. kinds and outcomes: [{"kind", "name",
/// "runs", "failed", "interval", and if there are runs "first_seed", "at_s", "text", "reproduce"}...].
[[nodiscard]] std::string to_json(const Results& results);

/// Reads it again. Problem: it is not of this form, or its numbers contradict each other.
[[nodiscard]] Result<Results> parse_results(std::string_view text);

/// The part of it that a controller writes (its runtime/src/run/schedule_report.hpp): counts and outcomes.
[[nodiscard]] Result<Results> parse_counts(std::string_view text);

}  // namespace tessera::statistics
