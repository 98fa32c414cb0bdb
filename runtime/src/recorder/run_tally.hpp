#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/recording.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// By what faults of the system, "NAME: what", are told from each other.
[[nodiscard]] inline std::string_view name_in_fault(std::string_view text) {
  return text.substr(0, text.find(": "));
}

/// Counts what happens in one run where nothing is recorded: firings, and faults by class and name.
///
/// Threads: the one of a simulated run.
class RunTally {
 public:
  /// All faults of one class and one name.
  struct SeenFault {
    Fault fault{};
    std::uint32_t instance = 0;  ///< or system_instance
    std::string name;            ///< of a fault of the system: as its text begins; else empty
    std::uint64_t count = 0;
    Time first{};
    std::string text;  ///< of the first
  };

  /// firings: a counter per transition, numbered as in recordings. Empty: firings are not counted.
  explicit RunTally(std::span<std::uint64_t> firings) : firings_(firings) {}

  void fire(std::uint32_t transition) {
    if (transition < firings_.size()) ++firings_[transition];
  }
  /// text: as in a recording. A fault of the system, "NAME: what", is told from others by its name.
  void note(std::uint32_t instance, Fault fault, Time time, std::string_view text);

  /// In the order in which they were first seen.
  [[nodiscard]] const std::vector<SeenFault>& faults() const { return faults_; }

 private:
  std::span<std::uint64_t> firings_;
  std::vector<SeenFault> faults_;
};

}  // namespace tessera
