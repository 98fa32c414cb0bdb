#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

/// Ensures that a process of a deployed system runs once on a machine. A second start would count as a
/// restart of the first, which the other processes would then ignore.
namespace tessera {

/// The identity of a process that may run only once. Other domains and network interfaces are other
/// deployments.
struct ClaimedProcess {
  std::string system, process;
  int domain = 0;
  std::string interface {};  ///< empty: "lo"
};

/// The claim of this program to be that process, made by an abstract socket. It holds as long as this object,
/// or until the program and its guardian process have died, and within one network namespace. If the program has died,
/// but its guardian is still at work, the constructor waits for it.
class ProcessClaim {
 public:
  explicit ProcessClaim(const ClaimedProcess& process);
  /// The claim to something else, such as a device. parts: name it.
  explicit ProcessClaim(std::span<const std::string> parts);
  ~ProcessClaim();
  ProcessClaim(const ProcessClaim&) = delete;
  ProcessClaim& operator=(const ProcessClaim&) = delete;
  /// The other program that has this claim; nullopt: there is none, or claims cannot be made here.
  [[nodiscard]] const std::optional<std::int64_t>& other() const { return other_; }

 private:
  int socket_ = -1;
  std::optional<std::int64_t> other_;  ///< its process id; 0: not known
};

/// "process gate of crossroads runs on this machine already (number 4711), ..."
[[nodiscard]] std::string runs_already(const ClaimedProcess& process, std::int64_t other);

}  // namespace tessera
