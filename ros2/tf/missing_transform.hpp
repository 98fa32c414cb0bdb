#pragma once

#include <chrono>
#include <optional>
#include <set>
#include <string>

#include "ros2/tf/transform_buffer.hpp"

namespace tessera::ros2 {

/// Reports why a receptor has had no transform for a while, once for each reason, and that it has one after that.
///
/// Threads: one at a time.
class MissingTransform {
 public:
  using Clock = std::chrono::steady_clock;
  /// Fast DDS repeats what a new subscriber has missed after three seconds, such as fixed transforms.
  static constexpr std::chrono::seconds patience{5};

  /// at: the buffer at whose stamps the transform is wanted; empty: at the newest time.
  MissingTransform(std::string frame, std::string in, std::string at, std::string topic,
                   Clock::time_point now);
  /// The text to print, if there is one. known: all frames, which are asked for only when something is printed.
  [[nodiscard]] std::optional<std::string> look(const TransformBuffer::Answer& answer, Clock::time_point now,
                                                const TransformBuffer& known);

 private:
  [[nodiscard]] std::string reason(const TransformBuffer::Answer& answer, const TransformBuffer& known) const;

  std::string frame_, in_, at_, topic_;
  std::optional<Clock::time_point> missing_since_;
  std::set<std::string> told_;  ///< reasons, since there was a transform
};

}  // namespace tessera::ros2
