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

/// Acts when the process is about to die during a run. All devices get their safe command. Then a message
/// says what happened, and where. Then the process dies as it would have died anyway (core dump, exit
/// status).
///
/// It notices SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT (abort, std::terminate), SIGSYS and SIGTRAP on every
/// thread, even after a stack overflow (AlternateStack). It also notices exit and quick_exit, which then
/// end the process with exit code 1. It cannot notice _exit and SIGKILL; the Guardian does.
///
/// Threads: one object at a time per process, constructed and destroyed by the run's thread.
class LastChance {
 public:
  /// How long a dying thread waits for the devices.
  static constexpr Duration patience = std::chrono::milliseconds(500);

  /// Acts from now on. On the steady clock, a thread stands ready to give devices their safe command.
  /// guardian: is notified of the death; nullptr: none.
  LastChance(Assembly& assembly, const Clock& clock, Guardian* guardian);
  LastChance(const LastChance&) = delete;
  LastChance& operator=(const LastChance&) = delete;
  ~LastChance();

  /// Returns when it has done everything it can. Async-signal-safe.
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
