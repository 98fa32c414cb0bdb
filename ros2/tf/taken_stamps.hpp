#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "ros2/codec/translator.hpp"

namespace tessera::ros2 {

/// The stamp of the newest message that the receptor of a topic has given, for transforms at the same time.
///
/// Threads: any.
class TakenStamp {
 public:
  /// That of the receptor with this path, such as "robot.laser.scan".
  [[nodiscard]] static std::shared_ptr<TakenStamp> of(const std::string& path);

  struct Numbered {
    std::uint64_t number = 0;  ///< from 1; 0: there is no stamp
    Stamp stamp{};
  };
  void set(const Stamp& stamp);
  [[nodiscard]] Numbered newest();

 private:
  std::mutex mutex_;
  Numbered newest_;
};

/// The time in the header with which a message begins; nullopt: the message is too short.
[[nodiscard]] std::optional<Stamp> stamp_of_header(std::span<const std::byte> message);
}  // namespace tessera::ros2
