#pragma once

#include <cstdint>
#include <optional>
#include <string>

/// A process of a deployed system runs once on a machine: a second start would be taken for a restart of the
/// first, which the other processes then do not listen to any more.
namespace tessera {

/// What may be there only once. Other domains and other interfaces of the network are other deployments.
struct ClaimedProcess {
  std::string system, process;
  int domain = 0;
  std::string interface {};  ///< empty: "lo"
};

/// The claim of this program to be that process. It holds as long as this object, or until the program dies, in one
/// network namespace, and is an abstract socket.
class ProcessClaim {
 public:
  explicit ProcessClaim(const ClaimedProcess& process);
  ~ProcessClaim();
  ProcessClaim(const ProcessClaim&) = delete;
  ProcessClaim& operator=(const ProcessClaim&) = delete;
  /// Another program is that process; nullopt: none is, or claims cannot be made here.
  [[nodiscard]] const std::optional<std::int64_t>& other() const { return other_; }

 private:
  int socket_ = -1;
  std::optional<std::int64_t> other_;  ///< its number; 0: not known
};

/// "process gate of crossroads runs on this machine already (number 4711), ..."
[[nodiscard]] std::string runs_already(const ClaimedProcess& process, std::int64_t other);

}  // namespace tessera
