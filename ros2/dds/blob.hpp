#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ros2/codec/related_identity.hpp"

struct ddsi_sertype;

/// Messages as their CDR bytes, for types that are known only at run time.
///
/// Cyclone DDS serialises types for which its IDL compiler has generated C code. A type from a specification
/// has no such code. So the topic has a type of its own kind ("sertype"), whose samples are the bytes of a
/// message, with their encapsulation header. rmw_cyclonedds_cpp does the same.
namespace tessera::ros2 {

/// A topic without keys, whose writers and readers exchange bytes.
struct BlobTopic {
  dds_entity_t entity = 0;             ///< negative: a code of Cyclone DDS
  const ddsi_sertype* type = nullptr;  ///< belongs to the topic
};
[[nodiscard]] BlobTopic create_blob_topic(dds_entity_t participant, const char* name, const char* type_name);

/// 0, or a negative code. The writer belongs to the topic.
[[nodiscard]] dds_return_t write_blob(dds_entity_t writer, const BlobTopic& topic,
                                      std::span<const std::byte> message);

/// The part of a datagram that is about a request and stands beside the message.
struct BesideMessage {
  RelatedIdentity related;
  std::int64_t sequence = 0;  ///< the number of the message itself
};

/// A received message, and the instance handle of its writer.
struct TakenBlob {
  std::span<const std::byte> message;
  dds_instance_handle_t writer = 0;
  std::optional<BesideMessage> beside{};
};
/// Takes the received messages, the oldest first, and passes each to `use`; at most `most`.
void take_blobs(dds_entity_t reader, std::size_t most, void (*use)(void* context, const TakenBlob& blob),
                void* context);

}  // namespace tessera::ros2
