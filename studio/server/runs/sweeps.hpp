#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "project/build/controller.hpp"
#include "project/process/process.hpp"
#include "server/analysis/analysis.hpp"
#include "server/analysis/spec_file.hpp"
#include "server/http/events.hpp"
#include "server/runs/sweep_results.hpp"

namespace tessera::server {

/// Many simulated runs of one controller: each value of a parameter with each seed.
struct SweepRequest {
  std::string parameter;            ///< path; empty: only the seeds differ
  std::vector<std::string> values;  ///< of the parameter, with their units
  std::uint64_t runs = 1;           ///< per value, each with the next seed
  std::uint64_t seed = 1;           ///< the first one
  std::string duration = "10s";
  bool interleave = false;  ///< the seed also decides the order of the subsystems, as in `tessera schedules`
};

/// Runs sweeps, one at a time, and publishes their results as events (`sweep`). The controller is built once. The runs
/// are not recorded; their results are kept in STATE/sweeps, so that the same sweep goes on where it was stopped.
///
/// Threads: any.
class Sweeps {
 public:
  Sweeps(SpecFile& file, Analyses& analyses, Events& events)
      : file_(file), analyses_(analyses), events_(events) {}
  ~Sweeps();
  Sweeps(const Sweeps&) = delete;
  Sweeps& operator=(const Sweeps&) = delete;

  static constexpr std::size_t most_values = 200, most_runs = 10'000, most_kept = 8;
  static constexpr double longest_s = 3600;

  struct Started {
    std::uint64_t sweep = 0;
    int status =
        202;  ///< otherwise 422: errors on disk, or a value that the parameter cannot have; 429: one goes on
    std::string error, hint;
  };
  [[nodiscard]] Started start(SweepRequest request);
  /// {"parameters", "processes", "sweeps"} of docs/reference/studio.md.
  [[nodiscard]] nlohmann::json list() const;
  /// {"sweep", "state", ...} with all rows; nullopt: no such sweep.
  [[nodiscard]] std::optional<nlohmann::json> info(std::uint64_t sweep) const;
  /// Ends a sweep; its results stay. false: no such sweep.
  bool stop(std::uint64_t sweep);
  /// Processes of a sweep at a time: one core is left for the page and its user.
  [[nodiscard]] static unsigned processes();

 private:
  struct Job {
    explicit Job(SweepRequest wanted) : request(std::move(wanted)) {}
    const SweepRequest request;
    std::atomic<bool> stop{false};
    std::thread thread;
    // Guarded by mutex_.
    std::string state = "building", why, line;
    std::vector<SweepRow> rows;
    std::size_t told = 0, reused = 0;
    std::int64_t told_at_ms = 0;
  };
  class BuildListener;
  struct Work;
  void run(std::uint64_t id, Job& job);
  void execute(std::uint64_t id, Job& job, project::Controller controller);
  void work(std::uint64_t id, Job& job, Work& all, unsigned process);
  void add(std::uint64_t id, Job& job, SweepRow row, bool reused);
  void end(std::uint64_t id, Job& job, const std::string& state, const std::string& why);
  /// Precondition: mutex_ is locked.
  [[nodiscard]] nlohmann::json facts(std::uint64_t id, const Job& job) const;
  void tell(std::uint64_t id, Job& job);
  /// Publishes the rows that are new: events of one sweep come in the order of its rows. Precondition: mutex_ is
  /// locked.
  void publish(std::uint64_t id, Job& job);

  SpecFile& file_;
  Analyses& analyses_;
  Events& events_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::unique_ptr<Job>> jobs_;
  std::uint64_t last_ = 0;
};

/// Why a parameter of the model cannot be varied over these values; empty: it can.
[[nodiscard]] std::string wrong_with_sweep(const spec::Model& model, const SweepRequest& request);

}  // namespace tessera::server
