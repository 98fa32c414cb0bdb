#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string_view>

#include "assembly/assembly.hpp"
#include "safety/death.hpp"
#include "safety/guardian.hpp"
#include "safety/rescue.hpp"
#include "system/thread_role.hpp"

namespace tessera {

/// What the process does when it is about to die in the middle of a run: all devices get their safe command,
/// then it is said what happened, and where, and then the process dies as it would have died anyway (core
/// dump, exit status).
///
/// Noticed are SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT (abort, std::terminate), SIGSYS and SIGTRAP, on every
/// thread, also when its stack has overflowed (AlternateStack), and exit and quick_exit, which end the
/// process with exit code 1. Not noticed are _exit and SIGKILL: that is what the Guardian is for.
///
/// Threads: one object at a time per process, constructed and destroyed by the run's thread.
class LastChance {
 public:
  /// So long a dying thread waits for the devices.
  static constexpr Duration patience = std::chrono::milliseconds(500);

  /// From now on. On the steady clock a thread waits to give devices their safe command. guardian: told of
  /// the death; nullptr: none.
  LastChance(Assembly& assembly, const Clock& clock, Guardian* guardian);
  LastChance(const LastChance&) = delete;
  LastChance& operator=(const LastChance&) = delete;
  ~LastChance();

  /// Async-signal-safe. Returns when everything is done that can be done.
  void use(const Death& death);

 private:
  void tell(std::string_view text) const;

  Assembly& assembly_;
  const Clock& clock_;
  Guardian* guardian_;
  std::array<char, 4096> note_file_{};
  const char* line_begin_;
  AlternateStack stack_;
  std::optional<Rescuer> rescuer_;
};

}  // namespace tessera
