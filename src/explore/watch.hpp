#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

namespace tessera::explore {

struct Progress {
  std::uint64_t markings = 0;
  double markings_per_second = 0;  ///< since the last report
  std::uint64_t bytes = 0;
  std::chrono::duration<double> elapsed{};
};

/// When to give up, and how to report progress.
struct Limits {
  std::chrono::duration<double> time{std::numeric_limits<double>::infinity()};
  std::uint64_t bytes = std::uint64_t{4} << 30U;                       ///< for markings and their tables
  std::uint64_t markings = std::numeric_limits<std::uint64_t>::max();  ///< approximately
  const std::atomic<bool>* stop = nullptr;                  ///< true: give up; may be set by a signal handler
  std::function<void(const Progress&)> progress = nullptr;  ///< called about every 0.2 s, in the same thread
};

/// The cost of an answer.
struct Effort {
  std::uint64_t markings = 0;  ///< stored
  std::uint64_t bytes = 0;     ///< largest amount in use
  std::chrono::duration<double> elapsed{};
};

/// Keeps one task, of one or several explorations, within its limits.
class Watch {
 public:
  explicit Watch(const Limits& limits);

  /// false, from then on, as soon as a limit is exceeded. Cheap enough for every few dozen markings.
  [[nodiscard]] bool go_on(std::uint64_t markings, std::uint64_t bytes);
  /// Gives up for another reason.
  void give_up(std::string why) { why_ = std::move(why); }
  /// The reason for giving up: "the time limit of 60 s is reached"; empty while it goes on.
  [[nodiscard]] const std::string& why() const { return why_; }
  [[nodiscard]] Effort effort() const;

 private:
  using Clock = std::chrono::steady_clock;
  void report(Clock::time_point now, std::uint64_t markings, std::uint64_t bytes);

  const Limits& limits_;
  std::string why_;
  Effort effort_;
  Clock::time_point start_, last_report_;
  std::uint64_t last_markings_ = 0;
};

}  // namespace tessera::explore
