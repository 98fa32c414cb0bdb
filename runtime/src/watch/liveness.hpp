#pragma once

#include "assembly/assembly.hpp"
#include "safety/guardian.hpp"
#include "system/service.hpp"

namespace tessera {

/// What tells others that the run goes on: the beats for the guardian, and for the watchdog of the service
/// manager as long as no subsystem stalls.
///
/// Threads: the one that supervises the run.
class Liveness {
 public:
  /// The run begins: all devices are open. guardian: nullptr: none.
  Liveness(Assembly& assembly, Guardian* guardian);
  Liveness(const Liveness&) = delete;
  Liveness& operator=(const Liveness&) = delete;
  /// The run is about to stop.
  ~Liveness();

  /// Call it whenever the supervisor is awake. Returns when to call it next; Time::max(): never. If the run
  /// has stood still so long that the guardian has acted, the run fails.
  [[nodiscard]] Time show(Time now);
  /// The process stops for a while (SIGTSTP), or goes on.
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
