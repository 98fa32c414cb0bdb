#pragma once

#include <pthread.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "subsystem/subsystem_executor.hpp"

namespace tessera {

/// Gives safe commands to devices of subsystems whose own threads do not. Each device gets a thread for
/// this, because a driver may not return. Repeats commands that are refused, or whose device is in use, for
/// as long as Effectors::patience.
///
/// Threads: the supervisor's.
class Securing {
 public:
  static constexpr Duration usual_time = std::chrono::milliseconds(20);

  /// priority: real-time priority of the threads; 0: none. news: called by a thread that has done its work.
  Securing(const std::vector<std::unique_ptr<SubsystemExecutor>>& executors, int priority,
           std::function<void()> news);
  Securing(const Securing&) = delete;
  Securing& operator=(const Securing&) = delete;
  /// Waits for its threads.
  ~Securing();

  /// Returns at once. Does nothing for devices that are being secured already.
  void secure(std::uint32_t instance, SafeReason why);
  /// Records what has been done. lane: the supervisor's.
  void collect(RecordingLane* lane);
  /// Whether no thread is at work.
  [[nodiscard]] bool done() const;
  [[nodiscard]] bool is_under_way(std::uint32_t instance) const;
  /// The devices that have not taken the safe command for Effectors::patience, since they refuse it or their
  /// driver does not return: "robot.motor.left". Call it before `collect`.
  [[nodiscard]] std::vector<std::string> refusing() const;
  /// Devices whose safe command takes longer than usual_time resist (Effectors::note_resistance): their drivers
  /// may not return.
  void note_resistance();
  /// When `refusing` may name another device, or `note_resistance` find one; Time::max(): no thread is at work.
  [[nodiscard]] Time overdue_from(Time now) const;
  /// Threads that do not return are left behind: neither this object nor what they use may be destroyed.
  void leave_behind();

 private:
  struct Job {
    Effectors* effectors = nullptr;
    std::size_t device = 0;
    SafeReason why{};
    const Securing* owner = nullptr;
    pthread_t thread{};
    bool started = false;  // and not joined
    std::int64_t since_ns = 0;
    bool resists = false;
    std::atomic<bool> done{false}, taken{false};
  };
  static void* run(void* job);
  [[nodiscard]] static bool is_under_way(const Job& job) {
    return job.started && !job.done.load(std::memory_order_acquire);
  }
  void secure(Job& job, SafeReason why) const;
  [[nodiscard]] bool start(Job& job, bool realtime) const;
  static void join(Job& job);

  int priority_;
  std::function<void()> news_;
  std::vector<std::vector<std::unique_ptr<Job>>> jobs_;  // per instance and device
};

}  // namespace tessera
