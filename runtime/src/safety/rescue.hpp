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
/// A driver must not be called in a signal handler: it may allocate, lock and throw. So the thread that dies
/// waits in its handler while this one calls the drivers. A driver that the dying thread was in is called
/// all the same, after the others; one that another thread is in is waited for. If a driver crashes here, the
/// next one follows.
///
/// Threads: `rescue` any, once, also in a signal handler; the rest the run's.
class Rescuer {
 public:
  /// Starts the thread. Throws std::system_error if there is none.
  /// priority: of the thread, real time; 0: as usual.
  Rescuer(std::span<const std::unique_ptr<SubsystemExecutor>> executors, int priority);
  Rescuer(const Rescuer&) = delete;
  Rescuer& operator=(const Rescuer&) = delete;
  ~Rescuer();

  /// Wakes the thread and waits until it is done, or until the limit is over. dead: the device that the
  /// calling thread was in, or nullptr (Effectors::device_in_call). Returns whether every device has taken
  /// its safe command.
  [[nodiscard]] bool rescue(const void* dead, Duration limit);

  /// If the calling thread is the one of a Rescuer that calls a driver, leaves that driver and does not
  /// return. Only in a signal handler.
  static void leave_crashed_driver();

 private:
  struct Patient {
    Effectors* effectors;
    std::size_t index;
    bool safe = false, crashed = false;
  };
  void run(int priority);
  void make_all_safe();
  [[nodiscard]] bool try_all(bool dead_too);
  void try_one(Patient& patient);

  std::vector<Patient> patients_;
  WakeWord asked_, answered_;
  enum class State : std::uint8_t { sleeps, is_asked, has_tried, has_succeeded, leaves };
  std::atomic<State> state_{State::sleeps};
  std::atomic<const void*> dead_{nullptr};
  std::atomic<std::int64_t> until_ns_{0};
  std::thread thread_;
};

}  // namespace tessera
