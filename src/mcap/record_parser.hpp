#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "mcap/records.hpp"

/// Parsers of the content of single records. Fields behind the known ones are ignored, as the format demands.
/// nullopt: the content is damaged.
namespace tessera::mcap {

/// A record as it stands in a file or in a chunk.
struct Record {
  std::uint8_t opcode = 0;
  std::string_view content;
  std::string_view rest;  ///< the bytes behind it
  [[nodiscard]] bool is(Opcode wanted) const { return opcode == static_cast<std::uint8_t>(wanted); }
};
/// nullopt: there is no whole record, or one that no version of the format has.
[[nodiscard]] std::optional<Record> next_record(std::string_view bytes);

[[nodiscard]] std::optional<Schema> parse_schema(std::string_view content);
[[nodiscard]] std::optional<Channel> parse_channel(std::string_view content);
[[nodiscard]] std::optional<Message> parse_message(std::string_view content);
/// Checks its sum.
[[nodiscard]] std::optional<Attachment> parse_attachment(std::string_view content);
[[nodiscard]] std::optional<Metadata> parse_metadata(std::string_view content);
[[nodiscard]] bool is_message_index(std::string_view content);

struct Chunk {
  std::uint64_t size = 0;
  std::uint32_t crc = 0;
  std::string_view compression, records;
};
/// Its records are neither decompressed nor checked.
[[nodiscard]] std::optional<Chunk> parse_chunk(std::string_view content);

struct Definitions {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  bool is_complete = false;  ///< the file ends as the format demands
  bool is_damaged = false;   ///< its check sum is wrong
};
/// The definitions in the summary of a whole file; empty: it has none, or one that is damaged.
[[nodiscard]] Definitions summary_of(std::string_view file);

}  // namespace tessera::mcap
