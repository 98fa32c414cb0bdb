#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "ros2/dds/endpoint.hpp"

namespace tessera::ros2 {

/// Reports when a topic has had no endpoint at the other side for a while, and when one appears after that.
/// DDS reports nothing about participants that it cannot reach. The long advice about the network comes once
/// for all topics of a participant, and never for an other side that was there.
///
/// Threads: one at a time.
class OtherSideWatch {
 public:
  using Clock = std::chrono::steady_clock;
  /// Discovery takes a second or two.
  static constexpr std::chrono::seconds patience{3};

  /// advised: whether the advice was given already; it must live as long as this.
  OtherSideWatch(const EndpointSetup& setup, bool writes, Clock::time_point now, std::atomic<bool>& advised);
  /// is_there: an endpoint of the other side is matched. is_misfit: whether there is one that does not fit, of
  /// which others tell; it is asked only if no endpoint has been matched for a while. Returns the text to
  /// print, if there is one.
  [[nodiscard]] std::optional<std::string> look(bool is_there, Clock::time_point now,
                                                const std::function<bool()>& is_misfit);

 private:
  std::string path_;
  std::string what_;  ///< "publishes /scan on interface lo in domain 0"
  Network network_;
  std::atomic<bool>& advised_;
  std::optional<Clock::time_point> alone_since_;
  bool told_ = false, was_there_ = false;
};

}  // namespace tessera::ros2
