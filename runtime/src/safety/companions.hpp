#pragma once

#include <memory>
#include <optional>
#include <string>

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
  /// From now on, the end of the guardian is reported, and the end of the parent
  /// stops the run as SIGTERM does.
  void watch();
  /// nullptr: none.
  [[nodiscard]] Guardian* guardian() const { return guardian_.get(); }

 private:
  const System& system_;
  const RunOptions& options_;
  std::unique_ptr<Guardian> guardian_;
  // declared after guardian_, so that they end before it
  std::optional<ProcessWatch> guardian_watch_, parent_watch_;
};

}  // namespace tessera
