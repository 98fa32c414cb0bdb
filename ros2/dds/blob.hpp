#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <span>
#include <vector>

struct ddsi_sertype;

/// Messages as their CDR bytes, for any type that is known only at run time.
///
/// Cyclone DDS serialises the types that its IDL compiler has made C code of. Types that come with a
/// specification have none. So the topic has a type of its own kind ("sertype"), whose samples are the bytes
/// of a message, with their encapsulation header. rmw_cyclonedds_cpp does the same.
namespace tessera::ros2 {

/// A topic without keys, whose writers and readers take and give bytes.
struct BlobTopic {
  dds_entity_t entity = 0;             ///< negative: a code of Cyclone DDS
  const ddsi_sertype* type = nullptr;  ///< belongs to the topic
};
[[nodiscard]] BlobTopic create_blob_topic(dds_entity_t participant, const char* name, const char* type_name);

/// 0, or a negative code. The writer is one of the topic.
[[nodiscard]] dds_return_t write_blob(dds_entity_t writer, const BlobTopic& topic,
                                      std::span<const std::byte> message);

/// A message that came, and the instance handle of its writer.
struct TakenBlob {
  std::span<const std::byte> message;
  dds_instance_handle_t writer = 0;
};
/// Takes the messages that have come, the oldest first, and gives each to `use`; at most `most`.
void take_blobs(dds_entity_t reader, std::size_t most, void (*use)(void* context, const TakenBlob& blob),
                void* context);

}  // namespace tessera::ros2
