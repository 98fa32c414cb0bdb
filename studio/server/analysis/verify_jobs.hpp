#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/analysis/analysis.hpp"
#include "server/http/events.hpp"

namespace tessera::server {

/// Runs verification in separate threads and publishes its progress as events (`verify`).
///
/// Threads: any.
class VerifyJobs {
 public:
  VerifyJobs(Analyses& analyses, Events& events) : analyses_(analyses), events_(events) {}
  ~VerifyJobs();
  VerifyJobs(const VerifyJobs&) = delete;
  VerifyJobs& operator=(const VerifyJobs&) = delete;

  static constexpr std::size_t most_running = 2, most_kept = 16;

  struct Request {
    std::string text;
    std::vector<std::string> properties;  ///< empty: all
    double seconds = 60;
  };
  struct Started {
    std::uint64_t job = 0;
    int status = 202;  ///< otherwise 422: no net to verify, or unknown properties; 429: too many jobs run
    std::string error, hint;
  };
  [[nodiscard]] Started start(Request request);
  /// {"job", "state", "result"}; nullopt: no such job.
  [[nodiscard]] std::optional<std::string> state(std::uint64_t job) const;
  /// Stops the job; properties that are not decided yet stay undecided. false: no such job.
  bool stop(std::uint64_t job);

 private:
  struct Job {
    std::atomic<bool> stop{false}, done{false};
    std::string result;  ///< set when the job is done; guarded by mutex_
    std::thread thread;
  };
  void run(std::uint64_t id, Job& job, const Analysis& analysis, const Request& request);
  void forget_old();

  Analyses& analyses_;
  Events& events_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::unique_ptr<Job>> jobs_;
  std::uint64_t last_ = 0;
};

}  // namespace tessera::server
