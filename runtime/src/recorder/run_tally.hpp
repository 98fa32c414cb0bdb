#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/recording.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The name by which faults of the system, "NAME: what", are told apart.
[[nodiscard]] inline std::string_view name_in_fault(std::string_view text) {
  return text.substr(0, text.find(": "));
}

/// Counts the events of a run that is not recorded: firings, and faults by class and name.
///
/// Threads: that of a simulated run.
class RunTally {
 public:
  /// All faults of one class and one name.
  struct SeenFault {
    Fault fault{};
    std::uint32_t instance = 0;  ///< or system_instance
    std::string name;            ///< for a fault of the system: the beginning of its text; otherwise empty
    std::uint64_t count = 0;
    Time first{};
    std::string text;  ///< of the first such fault
  };

  /// firings: a counter per transition, numbered as in recordings. Empty: firings are not counted.
  explicit RunTally(std::span<std::uint64_t> firings) : firings_(firings) {}

  void fire(std::uint32_t transition) {
    if (transition < firings_.size()) ++firings_[transition];
  }
  /// text: as in a recording. The name tells faults of the system, "NAME: what", apart.
  void note(std::uint32_t instance, Fault fault, Time time, std::string_view text);

  /// In the order in which they were first seen.
  [[nodiscard]] const std::vector<SeenFault>& faults() const { return faults_; }

 private:
  std::span<std::uint64_t> firings_;
  std::vector<SeenFault> faults_;
};

}  // namespace tessera
