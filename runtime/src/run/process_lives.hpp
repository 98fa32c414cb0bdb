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
/// A death stops all subsystems of the process at one instant, whatever they were doing. Their devices get
/// the safe
/// command, as a guardian would give it. A new start has subsystems, channels and devices that were made
/// anew, and
/// the next incarnation. What the process had sent is still on its way.
///
/// Threads: the run's.
class ProcessLives {
 public:
  /// Where something happens next; Time::max(): nowhere.
  [[nodiscard]] Time next(const Assembly& assembly) const;
  /// A dead process will begin again.
  [[nodiscard]] bool awaits_start() const { return !starts_.empty(); }

  struct Change {
    bool died = false;                       ///< else begun again
    std::vector<std::uint32_t> instances{};  ///< of the process
  };
  /// Makes the next change that is due happen; nullopt: none is due, or `error` says what failed.
  [[nodiscard]] std::optional<Change> follow(Assembly& assembly, UpperLayers& upper, Time now,
                                             std::string& error);
  /// Firings of starts that have ended.
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
