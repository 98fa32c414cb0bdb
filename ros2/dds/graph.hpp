#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ros2/dds/blob.hpp"

namespace tessera::ros2 {

/// The size of the identifiers of a message of ros_discovery_info (rmw_dds_common/msg/ParticipantEntitiesInfo):
/// 24 bytes up to ROS 2 Humble, 16 since. DDS identifiers have 16, so the rest of Humble's is zero; at the same
/// place the other form has the number of nodes and the length of a text. nullopt: it is no such message.
[[nodiscard]] std::optional<std::size_t> identifier_size_in(std::span<const std::byte> message);

/// The nodes of a participant, as `ros2 node list` and `ros2 topic info -v` see them: it writes the topic
/// ros_discovery_info.
///
/// **The form.** A node of Humble throws when it reads the later form. A later node that reads Humble's form
/// finds no nodes in it, and nothing else happens. So the later form is written only while some other
/// participant writes it, and none writes Humble's; the message is written again when that changes. Programs
/// of Tessera do not count, since they follow the others too.
///
/// Threads: any.
class Graph {
 public:
  /// Throws std::runtime_error.
  explicit Graph(dds_entity_t participant);
  ~Graph();
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  /// node: its full name, "/left/robot".
  void add(const std::string& node, dds_entity_t endpoint, bool writes);
  void remove(dds_entity_t endpoint);

 private:
  struct Endpoint {
    std::string node;
    dds_entity_t entity;
    bool writes;
  };
  void open();
  void close();
  void hear();
  void note(const TakenBlob& blob);
  [[nodiscard]] std::size_t identifier_size() const;
  void put_identifier(class CdrWriter& writer, dds_entity_t entity) const;
  void announce();

  std::mutex mutex_;
  dds_entity_t participant_, writer_ = 0, reader_ = 0;
  BlobTopic topic_;
  std::vector<Endpoint> endpoints_;
  std::map<dds_instance_handle_t, std::size_t> heard_;  ///< the sizes of identifiers of other participants
  std::size_t written_ = 0;                             ///< that of our last message
};

}  // namespace tessera::ros2
