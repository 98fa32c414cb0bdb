#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "assembly/assembly.hpp"
#include "assembly/upper_layers.hpp"

namespace tessera {

/// Processes that die and begin again in a simulated run, as `--inject process:...` says.
///
/// A death stops all subsystems of the process at one instant, in any state. Their devices get the safe
/// command, as a guardian would give it. A new start has new subsystems, channels and devices, and the next
/// incarnation. Messages that the process had sent are still on their way.
///
/// Threads: the run's.
class ProcessLives {
 public:
  /// The time of the next change; Time::max(): there is none.
  [[nodiscard]] Time next(const Assembly& assembly) const;
  /// Whether a dead process will begin again.
  [[nodiscard]] bool awaits_start() const { return !starts_.empty(); }

  struct Change {
    bool died = false;                       ///< otherwise it began again
    std::vector<std::uint32_t> instances{};  ///< of the process
  };
  /// Carries out the next change that is due; nullopt: none is due, or `error` says what failed.
  [[nodiscard]] std::optional<Change> follow(Assembly& assembly, UpperLayers& upper, Time now,
                                             std::string& error);
  /// The number of firings of starts that have ended.
  [[nodiscard]] static std::uint64_t past_firings(const Assembly& assembly);

 private:
  struct Start {
    std::uint32_t process;
    Time at;
  };
  [[nodiscard]] Change die(Assembly& assembly, UpperLayers& upper, const Outage& outage, Time now);
  [[nodiscard]] std::optional<Change> begin(Assembly& assembly, UpperLayers& upper, std::uint32_t process,
                                            Time now, std::string& error);
  [[nodiscard]] network::Incarnation incarnation(const Assembly& assembly, std::uint32_t process) const;
  void tell(Assembly& assembly, std::uint32_t process, bool begins, Time now) const;

  std::size_t deaths_ = 0;              // of Assembly::outages
  std::vector<Start> starts_;           // of processes that are dead
  std::vector<std::uint64_t> started_;  // per process: starts after the first
};

}  // namespace tessera
