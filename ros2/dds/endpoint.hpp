#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ros2/dds/blob.hpp"
#include "ros2/dds/domain.hpp"
#include "ros2/naming/names.hpp"
#include "tessera/time.hpp"

namespace tessera::ros2 {

/// What an endpoint of a topic is made of.
struct EndpointSetup {
  std::string path;   ///< of the driver, for messages
  std::string topic;  ///< "/cmd_vel"
  std::string type;   ///< "geometry_msgs/msg/Twist"
  std::string node;
  Qos qos;
  Network network;
};

/// A writer or reader of a topic of ROS 2. If the other side has a quality of service that does not go
/// together with ours, a warning says so on standard error.
///
/// Threads: one at a time.
class Endpoint {
 public:
  /// Throws std::runtime_error.
  Endpoint(const EndpointSetup& setup, bool writes);
  ~Endpoint();
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;

  /// Whether the other side was found within this time.
  [[nodiscard]] bool await_other_side(Duration timeout) const;
  /// Of a writer: false: DDS refused.
  [[nodiscard]] bool write(std::span<const std::byte> message);
  /// Of a reliable writer: whether all that are there have got everything within this time.
  [[nodiscard]] bool await_receipt(Duration timeout) const;
  /// Of a reader: gives the messages that came since the last call, the oldest first.
  void take(void (*use)(void* context, std::span<const std::byte>), void* context) const;

 private:
  /// What listeners need; it does not move.
  struct Told {
    std::string path, topic;
    bool writes;
  };
  static void tell_of_qos(const Told& told, std::uint32_t policy);

  std::shared_ptr<Participant> participant_;
  std::unique_ptr<Told> told_;
  BlobTopic topic_;
  dds_entity_t entity_ = 0;
  bool writes_;
  std::size_t depth_;
};

}  // namespace tessera::ros2
