#pragma once

#include <list>
#include <optional>
#include <string>
#include <vector>

#include "tessera/controller.hpp"
#include "tessera/process_claim.hpp"

namespace tessera {

/// The folder of the project of this program: PROJECT/.tessera/build/release/controller is of PROJECT. A controller
/// that was copied elsewhere is of its own folder.
[[nodiscard]] std::string project_of_this_program();

/// The claim of a run to the real devices that it opens: those of its project, and its serial devices, whatever
/// project names them. Two runs would give one robot the commands of both.
///
/// The claims end with this object, or when the process dies. They hold for all users of a machine, but not across
/// network namespaces.
class DeviceClaims {
 public:
  /// Claims nothing if the run opens no real device, may share them (RunOptions::also), or is of no project.
  DeviceClaims(const System& system, const RunOptions& options);
  /// Why the run must not start: another one has a device. nullopt: none has.
  [[nodiscard]] const std::optional<std::string>& refusal() const { return refusal_; }

 private:
  void claim(const std::vector<std::string>& parts, const std::string& what);
  std::list<ProcessClaim> claims_;
  std::optional<std::string> refusal_;
};

}  // namespace tessera
