#pragma once

#include <memory>
#include <optional>
#include <string>

#include "drivers/run_control.hpp"
#include "safety/guardian.hpp"
#include "system/process_watch.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// Other processes on which a run depends, or which depend on it: the guardian, and the process that
/// has started the controller.
///
/// Threads: the run's.
class Companions {
 public:
  Companions(const System& system, const RunOptions& options) : system_(system), options_(options) {}

  /// Forks the guardian if it is needed. Call it before the process has threads. false and
  /// `error`: the run cannot start.
  [[nodiscard]] bool start_guardian(std::string& error);
  /// From now on, the end of the parent stops the run as SIGTERM does.
  void watch_parent();
  /// As long as the result exists, the run stops and has failed if the guardian ends or stands still: no process
  /// would make the devices safe if this one died. nullptr: there is no guardian. `control` must outlive the result.
  [[nodiscard]] std::unique_ptr<ProcessWatch> watch_guardian(RunControl& control) const;
  /// nullptr: none.
  [[nodiscard]] Guardian* guardian() const { return guardian_.get(); }

 private:
  const System& system_;
  const RunOptions& options_;
  std::unique_ptr<Guardian> guardian_;
  std::optional<ProcessWatch> parent_watch_;
};

}  // namespace tessera
