#pragma once

#include "assembly/assembly.hpp"
#include "safety/guardian.hpp"
#include "system/service.hpp"

namespace tessera {

/// Signals that the run goes on: beats for the guardian and, as long as no subsystem stalls, for the
/// watchdog of the service manager.
///
/// Threads: the one that supervises the run.
class Liveness {
 public:
  /// The run begins: all devices are open. guardian: may be nullptr.
  Liveness(Assembly& assembly, Guardian* guardian);
  Liveness(const Liveness&) = delete;
  Liveness& operator=(const Liveness&) = delete;
  /// Nothing can stand still unnoticed from here on: the threads that command devices have ended, or are given up.
  ~Liveness();

  /// Call it whenever the supervisor is awake. Returns when to call it next; Time::max(): never. If the run
  /// has stood still for so long that the guardian has acted, the run fails.
  [[nodiscard]] Time show(Time now);
  /// The run stops. `show` goes on: the process may stand still before the devices have their safe commands.
  void stopping() { manager_.stopping(); }
  /// The process is suspended (SIGTSTP), or continues.
  void suspend();
  void resume();

 private:
  [[nodiscard]] bool somebody_stalls() const;
  void tell_status();
  Assembly& assembly_;
  Guardian* guardian_;
  ServiceManager manager_;
  Time next_beat_{};
  bool stalled_ = false;
};

}  // namespace tessera
