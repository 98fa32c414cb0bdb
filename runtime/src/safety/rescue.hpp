#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "subsystem/subsystem_executor.hpp"
#include "system/waker.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// A thread that sleeps until the process is about to die, and then gives all devices their safe command.
///
/// A driver must not be called in a signal handler, because it may allocate, lock and throw. So the dying
/// thread waits in its handler while this thread calls the drivers. If the dying thread was in a driver,
/// that driver is called after the others. If another thread is in a driver, this thread waits for it. If a
/// driver crashes here, the next one follows.
///
/// Threads: `rescue` any, once, also in a signal handler; the rest the run's.
class Rescuer {
 public:
  /// Starts the thread. Throws std::system_error if that fails. priority: real-time
  /// priority of the thread; 0: none.
  Rescuer(std::span<const std::unique_ptr<SubsystemExecutor>> executors, int priority);
  Rescuer(const Rescuer&) = delete;
  Rescuer& operator=(const Rescuer&) = delete;
  ~Rescuer();

  /// Wakes the thread and waits until it is done, or until the time limit. dead: the device whose driver
  /// the calling thread was in, or nullptr (Effectors::device_in_call). Returns whether every device
  /// has taken its safe command.
  [[nodiscard]] bool rescue(const void* dead, Duration limit);

  /// If the calling thread is that of a Rescuer and calls a driver, leaves that driver and does not
  /// return. Only for signal handlers.
  static void leave_crashed_driver();

 private:
  struct RescuedDevice {
    Effectors* effectors;
    std::size_t index;
    bool safe = false, crashed = false;
  };
  void run(int priority);
  void make_all_safe();
  [[nodiscard]] bool try_all(bool dead_too);
  void try_one(RescuedDevice& device);

  std::vector<RescuedDevice> devices_;
  WakeWord asked_, answered_;
  enum class State : std::uint8_t { sleeps, is_asked, has_tried, has_succeeded, leaves };
  std::atomic<State> state_{State::sleeps};
  std::atomic<const void*> dead_{nullptr};
  std::atomic<std::int64_t> until_ns_{0};
  std::thread thread_;
};

}  // namespace tessera
