#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mcap/records.hpp"

namespace tessera::mcap {

/// Makes the bytes of a file, which its user takes and writes. All bytes that it gives are whole records. So a
/// file that was written up to any point can be read up to its last whole chunk.
///
/// Threads: one at a time.
class Writer {
 public:
  /// profile: "ros2", or empty. library: the name of the program.
  Writer(std::string_view profile, std::string_view library);

  /// The number of a new schema. Precondition: fewer than 65,535 exist.
  std::uint16_t add_schema(std::string name, std::string encoding, std::string data);
  /// The number of a new channel; `id` of the argument means nothing. Precondition: fewer than 65,536 exist.
  std::uint16_t add_channel(Channel channel);
  /// Closes the open chunk: an attachment stands in none.
  void attach(const Attachment& attachment);
  void add_metadata(const Metadata& metadata);
  /// Its sequence number is the number of earlier messages of the channel.
  void write(std::uint16_t channel, std::uint64_t log_ns, std::uint64_t publish_ns, std::string_view data);
  /// The messages of the open chunk in bytes.
  [[nodiscard]] std::size_t open_bytes() const { return chunk_.size(); }
  /// Nothing happens if no chunk is open.
  void close_chunk();
  /// Writes the summary, with which readers find messages by time and topic. It is the last call but `take`.
  void finish();

  /// All complete records that have not been taken.
  [[nodiscard]] std::string take();

 private:
  struct ChunkEntry {
    std::uint64_t start_ns, end_ns, offset, length;
    std::vector<std::pair<std::uint16_t, std::uint64_t>> message_indexes;  ///< channel, offset
    std::uint64_t indexes_length, compressed, uncompressed;
    bool is_compressed;
  };
  struct AttachmentEntry {
    std::uint64_t offset, length, log_ns, size;
    std::string name, media_type;
  };
  struct MetadataEntry {
    std::uint64_t offset, length;
    std::string name;
  };

  void put(Opcode opcode, std::string_view content);
  [[nodiscard]] std::uint64_t at() const { return taken_ + out_.size(); }
  void put_message_indexes(ChunkEntry& entry);
  void put_summary();
  void put_statistics();

  std::string out_;
  std::uint64_t taken_ = 0;
  std::uint32_t crc_ = 0;  // of everything that has been taken
  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
  std::vector<std::uint64_t> counts_;  // per channel
  std::string chunk_;
  std::uint64_t start_ns_ = 0, end_ns_ = 0;                                              // of the open chunk
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index_;  // time, offset
  std::vector<ChunkEntry> chunks_;
  std::vector<AttachmentEntry> attachments_;
  std::vector<MetadataEntry> metadata_;
};

}  // namespace tessera::mcap
