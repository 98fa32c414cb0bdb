#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "ros2/dds/endpoint.hpp"

namespace tessera::ros2 {

/// Tells when a topic has had nobody at the other side for a while, and when somebody comes after that. DDS says
/// nothing about participants that it cannot reach.
///
/// Threads: one at a time.
class OtherSideWatch {
 public:
  using Clock = std::chrono::steady_clock;
  /// Discovery takes a second or two.
  static constexpr std::chrono::seconds patience{3};

  OtherSideWatch(const EndpointSetup& setup, bool writes, Clock::time_point now);
  /// is_there: somebody at the other side is matched. The text to print, if there is one.
  [[nodiscard]] std::optional<std::string> look(bool is_there, Clock::time_point now);

 private:
  std::string path_;
  std::string what_;  ///< "publishes /scan on interface lo in domain 0"
  Network network_;
  std::optional<Clock::time_point> alone_since_;
  bool told_ = false;
};

}  // namespace tessera::ros2
