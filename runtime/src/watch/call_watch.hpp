#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "assembly/assembly.hpp"

namespace tessera {

/// Watches the one thread of a simulated run from another thread. User code that does not return blocks the
/// whole run, which then cannot notice a request to stop.
///
/// A turn that has not ended after a second of real time is reported, and again after two, four and
/// so on seconds. If a signal asks the run to stop and the same turn still lasts a second later, the
/// process ends with 128 plus the number of the signal. Before that, the devices get their safe command
/// and the recording is written.
///
/// Threads: the run's, except its own thread.
class CallWatch {
 public:
  explicit CallWatch(Assembly& assembly);
  CallWatch(const CallWatch&) = delete;
  CallWatch& operator=(const CallWatch&) = delete;
  ~CallWatch();

  /// Between begin and end, that subsystem has the thread.
  void begin(std::uint32_t instance, Time now) {
    instance_.store(instance, std::memory_order_relaxed);
    now_.store(now, std::memory_order_relaxed);
    turns_.store(turns_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }
  void end() {
    // Sequentially consistent with the load in the thread that gives up: either that thread sees the end of
    // the turn, or this thread does not continue beside it.
    turns_.store(turns_.load(std::memory_order_relaxed) + 1, std::memory_order_seq_cst);
    if (gives_up_.load(std::memory_order_seq_cst)) wait_for_decision();
  }

 private:
  struct Look {
    std::uint64_t turn = 0;
    double began_s = 0, said_s = 0;
    std::optional<double> asked_s{};
  };
  void watch();
  void look(Look& last);
  void give_up(const Look& last);
  void wait_for_decision() const;
  [[nodiscard]] std::string function() const;

  Assembly& assembly_;
  std::atomic<std::uint64_t> turns_{0};  // odd: in a turn
  std::atomic<std::uint32_t> instance_{0};
  std::atomic<Time> now_{Time{}};
  std::atomic<bool> gives_up_{false};
  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  std::thread thread_;  // the last member: it looks at the others
};

}  // namespace tessera
