#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "assembly/assembly.hpp"

namespace tessera {

/// Keeps the devices of all subsystems open while it exists.
///
/// Threads: the run's. close_what_can_be_closed: also another one, while the run's is held in a driver.
class OpenDevices {
 public:
  /// For closing devices if a driver does not return.
  static constexpr std::chrono::seconds closing_patience{1};

  explicit OpenDevices(Assembly& assembly) : assembly_(assembly) {}
  OpenDevices(const OpenDevices&) = delete;
  OpenDevices& operator=(const OpenDevices&) = delete;
  /// Acts only if the run ends by an exception; every other run has given the safe
  /// command and called `close`.
  ~OpenDevices();

  /// Effectors are opened first, so that they are safe soon. false and `error`: the run must not start; all
  /// devices are closed again.
  [[nodiscard]] bool open(std::string& error);
  /// Returns the failures.
  std::vector<std::string> close();
  /// The same, for no longer than `closing_patience`: a driver that does not return may block the others.
  /// left_behind: per instance, whether its devices stay open; empty: none.
  void close_what_can_be_closed(const std::vector<bool>& left_behind);

 private:
  Assembly& assembly_;
  bool open_ = false, all_open_ = false;
};

}  // namespace tessera
