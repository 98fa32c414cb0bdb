#pragma once

#include <dds/dds.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "ros2/codec/related_identity.hpp"

namespace tessera::ros2 {

/// Finds other writers of a topic that should have one, such as the commands of a robot. A writer is matched
/// with readers only, so that DDS tells of other writers by its built-in topic alone.
///
/// Threads: one at a time.
class OtherWriters {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds between_looks{500};

  /// own: our writer of the topic. Throws std::runtime_error.
  OtherWriters(dds_entity_t participant, dds_entity_t own, std::string dds_topic);
  ~OtherWriters();
  OtherWriters(const OtherWriters&) = delete;
  OtherWriters& operator=(const OtherWriters&) = delete;

  struct Writer {
    std::string type;         ///< "geometry_msgs::msg::dds_::Twist_"
    std::string participant;  ///< the first twelve bytes of its GUID, as `ros2 topic info -v` shows them
    bool own_process = false;
  };
  /// Those that were found since the last call. A look within `between_looks` of the last one finds none.
  [[nodiscard]] std::vector<Writer> look(Clock::time_point now);
  /// From now on, the writers of the participant of that endpoint are left out.
  void take_for_ours(const Guid& endpoint) { ours_ = endpoint; }

 private:
  std::string topic_;
  dds_guid_t own_{}, participant_{};
  std::optional<Guid> ours_;
  dds_entity_t reader_ = 0;
  Clock::time_point next_look_{};
};

}  // namespace tessera::ros2
