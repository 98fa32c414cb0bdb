#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <thread>

#include "subsystem/subsystem_executor.hpp"
#include "system/waker.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// Threads that sleep until the process is about to die, and then give all devices their safe command.
///
/// A driver must not be called in a signal handler, because it may allocate, lock and throw. So the dying
/// thread waits in its handler while these threads call the drivers. If the dying thread was in a driver,
/// that driver is called after the others. If another thread is in a driver, it is tried again and again. If a
/// driver crashes here, the next one follows. If drivers hang, such as one that waits for a lock of the dying
/// thread, the other devices are served as long as fewer of them hang than there are threads.
///
/// Threads: `rescue` any, once, also in a signal handler; the rest the run's.
class Rescuer {
 public:
  static constexpr std::size_t most_threads = 4;
  /// Starts the threads. Throws std::system_error if that fails. priority: their real-time priority; 0: none.
  Rescuer(std::span<const std::unique_ptr<SubsystemExecutor>> executors, int priority);
  Rescuer(const Rescuer&) = delete;
  Rescuer& operator=(const Rescuer&) = delete;
  ~Rescuer();

  /// Wakes the threads and waits until they are done, or until the time limit. dead: the device whose driver
  /// the calling thread was in, or nullptr (Effectors::device_in_call). Returns whether every device
  /// has taken its safe command.
  [[nodiscard]] bool rescue(const void* dead, Duration limit);

  /// If the calling thread is one of a Rescuer and calls a driver, leaves that driver and does not
  /// return. Only for signal handlers.
  static void leave_crashed_driver();

 private:
  struct RescuedDevice {
    RescuedDevice(Effectors& its_effectors, std::size_t its_index)
        : effectors(&its_effectors), index(its_index) {}
    Effectors* effectors;
    std::size_t index;
    std::atomic<bool> safe{false}, crashed{false}, tried{false};  // tried: by a thread, now
  };
  struct Thread {
    WakeWord asked;
    std::thread thread;
  };
  void end_threads();
  void run(WakeWord& asked, int priority);
  void make_all_safe();
  [[nodiscard]] bool try_all(bool dead_too);
  void try_one(RescuedDevice& device);

  std::deque<RescuedDevice> devices_;
  WakeWord answered_;
  enum class State : std::uint8_t { sleeps, is_asked, has_tried, has_succeeded, leaves };
  std::atomic<State> state_{State::sleeps};
  std::atomic<const void*> dead_{nullptr};
  std::atomic<std::int64_t> until_ns_{0};
  std::deque<Thread> threads_;
};

}  // namespace tessera
