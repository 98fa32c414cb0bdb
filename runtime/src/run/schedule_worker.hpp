#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "run/schedule_report.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// Memory that a process and the processes it forks share. It outlives the death of any of them.
class SharedCounters {
 public:
  /// All zero. Throws std::bad_alloc.
  explicit SharedCounters(std::size_t count);
  SharedCounters(const SharedCounters&) = delete;
  SharedCounters& operator=(const SharedCounters&) = delete;
  ~SharedCounters();
  [[nodiscard]] std::span<std::uint64_t> all() const { return all_; }

 private:
  std::span<std::uint64_t> all_;
};

/// The seeds of all runs, which the workers take one by one, and the present seed of each worker.
class SeedQueue {
 public:
  SeedQueue(std::uint64_t first, std::uint64_t count, unsigned workers)
      : counters_(1 + std::size_t{workers}), first_(first), count_(count) {}

  /// The next seed for a worker; nullopt: all are taken. From any process.
  [[nodiscard]] std::optional<std::uint64_t> take(unsigned worker);
  /// The seed that a worker took last; nullopt: none.
  [[nodiscard]] std::optional<std::uint64_t> taken_by(unsigned worker) const;
  [[nodiscard]] bool empty() const { return at(0).load() >= count_; }

 private:
  [[nodiscard]] std::atomic_ref<std::uint64_t> at(std::size_t index) const {
    return std::atomic_ref<std::uint64_t>(counters_.all()[index]);
  }
  SharedCounters counters_;  // how many are taken; then per worker: 1 + the number of its run
  std::uint64_t first_, count_;
};

/// A process that runs the system again and again, with seeds from a queue. If it dies in a run, only that
/// run is lost.
///
/// Threads: those of the process that has forked it.
class ScheduleWorker {
 public:
  struct Task {
    const System& system;
    const RunOptions& options;  ///< of each run, but for the seed
    SeedQueue& seeds;
    std::span<std::uint64_t> firings;  ///< per transition, in shared memory; empty: not counted
    bool quiet = false;                ///< standard error of the process is discarded
  };
  /// Forks. Throws std::runtime_error if that is not possible.
  ScheduleWorker(const Task& task, unsigned number);
  ScheduleWorker(ScheduleWorker&&) noexcept = default;
  ScheduleWorker& operator=(ScheduleWorker&&) noexcept = default;
  /// Kills the process if it still runs.
  ~ScheduleWorker();

  [[nodiscard]] unsigned number() const { return number_; }
  /// Readable when it has sent a line, or has ended.
  [[nodiscard]] int descriptor() const;
  /// Its lines since the last call. Does not wait.
  struct News {
    std::vector<ScheduleResult> results;
    struct Refusal {
      std::uint64_t seed;
      std::string why;
    };
    std::vector<Refusal> refusals;  ///< runs that could not start
    bool ended = false;
  };
  [[nodiscard]] News read();
  void signal(int signal) const;
  /// Waits for its end. Returns how it died, "killed by SIGSEGV at address 0x0 in robot.control.follow";
  /// empty: it ended normally.
  [[nodiscard]] std::string death();

 private:
  struct Process;
  std::unique_ptr<Process> process_;
  unsigned number_;
};

}  // namespace tessera
