#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace tessera::network {

/// When a message that may be lost is sent again: after 20 ms, then after twice as long each time, up to 500
/// ms. A recall is sent three times in all, 20 ms apart, because its sender waits for no answer.
class Repetition {
 public:
  using Duration = std::chrono::nanoseconds;
  static constexpr Duration first{std::chrono::milliseconds(20)}, longest{std::chrono::milliseconds(500)};
  static constexpr std::uint32_t recalls = 3;

  /// A new message was sent, or one to a new peer.
  void start(bool recall) {
    recall_ = recall;
    sent_ = 1;
    next_ = first;
  }
  /// The time from the last message to the next; nullopt: there is none.
  [[nodiscard]] std::optional<Duration> interval() const {
    return sent_ == 0 || (recall_ && sent_ >= recalls) ? std::nullopt : std::optional(next_);
  }
  /// The message was sent again.
  void again();
  void stop() { sent_ = 0; }

 private:
  bool recall_ = false;
  std::uint32_t sent_ = 0;
  Duration next_ = first;
};

}  // namespace tessera::network
