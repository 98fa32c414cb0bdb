#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "ros2/dds/endpoint.hpp"

namespace tessera::ros2 {

/// Reports when a topic has had no endpoint at the other side for a while, and when one appears after that.
/// DDS reports nothing about participants that it cannot reach.
///
/// Threads: one at a time.
class OtherSideWatch {
 public:
  using Clock = std::chrono::steady_clock;
  /// Discovery takes a second or two.
  static constexpr std::chrono::seconds patience{3};

  OtherSideWatch(const EndpointSetup& setup, bool writes, Clock::time_point now);
  /// is_there: an endpoint of the other side is matched. Returns the text to print, if there is one.
  [[nodiscard]] std::optional<std::string> look(bool is_there, Clock::time_point now);

 private:
  std::string path_;
  std::string what_;  ///< "publishes /scan on interface lo in domain 0"
  Network network_;
  std::optional<Clock::time_point> alone_since_;
  bool told_ = false;
};

}  // namespace tessera::ros2
