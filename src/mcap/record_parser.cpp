#include "mcap/record_parser.hpp"

#include "mcap/byte_order.hpp"
#include "mcap/compression.hpp"
#include "mcap/crc32.hpp"

namespace tessera::mcap {

std::optional<Record> next_record(std::string_view bytes) {
  Cursor cursor(bytes);
  Record record;
  record.opcode = cursor.number<std::uint8_t>();
  record.content = cursor.take(cursor.number<std::uint64_t>());
  record.rest = cursor.rest();
  if (!cursor.ok() || record.opcode == 0) return std::nullopt;
  return record;
}

std::optional<Schema> parse_schema(std::string_view content) {
  Cursor cursor(content);
  Schema schema;
  schema.id = cursor.number<std::uint16_t>();
  schema.name = cursor.text();
  schema.encoding = cursor.text();
  schema.data = cursor.text();
  if (!cursor.ok()) return std::nullopt;
  return schema;
}

std::optional<Channel> parse_channel(std::string_view content) {
  Cursor cursor(content);
  Channel channel;
  channel.id = cursor.number<std::uint16_t>();
  channel.schema = cursor.number<std::uint16_t>();
  channel.topic = cursor.text();
  channel.encoding = cursor.text();
  channel.metadata = cursor.map();
  if (!cursor.ok()) return std::nullopt;
  return channel;
}

std::optional<Message> parse_message(std::string_view content) {
  Cursor cursor(content);
  Message message;
  message.channel = cursor.number<std::uint16_t>();
  message.sequence = cursor.number<std::uint32_t>();
  message.log_ns = cursor.number<std::uint64_t>();
  message.publish_ns = cursor.number<std::uint64_t>();
  message.data = cursor.rest();
  if (!cursor.ok()) return std::nullopt;
  return message;
}

std::optional<Attachment> parse_attachment(std::string_view content) {
  Cursor cursor(content);
  Attachment attachment;
  attachment.log_ns = cursor.number<std::uint64_t>();
  static_cast<void>(cursor.number<std::uint64_t>());  // when the file was created
  attachment.name = cursor.text();
  attachment.media_type = cursor.text();
  attachment.data = cursor.take(cursor.number<std::uint64_t>());
  const std::string_view summed = content.substr(0, content.size() - cursor.rest().size());
  const auto crc = cursor.number<std::uint32_t>();
  if (!cursor.ok() || (crc != 0 && crc != crc32(summed))) return std::nullopt;
  return attachment;
}

std::optional<Metadata> parse_metadata(std::string_view content) {
  Cursor cursor(content);
  Metadata metadata;
  metadata.name = cursor.text();
  metadata.entries = cursor.map();
  if (!cursor.ok()) return std::nullopt;
  return metadata;
}

bool is_message_index(std::string_view content) {
  Cursor cursor(content);
  static_cast<void>(cursor.number<std::uint16_t>());
  static_cast<void>(cursor.take(cursor.number<std::uint32_t>()));
  return cursor.ok() && cursor.rest().empty();
}

std::optional<Chunk> parse_chunk(std::string_view content) {
  Cursor cursor(content);
  Chunk chunk;
  static_cast<void>(cursor.take(2 * sizeof(std::uint64_t)));  // the times of its messages
  chunk.size = cursor.number<std::uint64_t>();
  chunk.crc = cursor.number<std::uint32_t>();
  chunk.compression = cursor.take(cursor.number<std::uint32_t>());
  chunk.records = cursor.take(cursor.number<std::uint64_t>());
  const bool known =
      chunk.compression == zstd || chunk.compression == lz4 || chunk.compression == uncompressed;
  if (!cursor.ok() || !known || chunk.size > largest_chunk) return std::nullopt;
  return chunk;
}

Definitions summary_of(std::string_view file) {
  constexpr std::size_t footer_size = 1 + 8 + 20;
  Definitions definitions;
  if (!file.ends_with(magic) || file.size() < 2 * magic.size() + footer_size) return definitions;
  const std::size_t footer_at = file.size() - magic.size() - footer_size;
  const std::optional<Record> footer = next_record(file.substr(footer_at));
  if (!footer || !footer->is(Opcode::footer)) return definitions;
  definitions.is_complete = true;
  Cursor cursor(footer->content);
  const auto start = cursor.number<std::uint64_t>();
  static_cast<void>(cursor.number<std::uint64_t>());
  const auto crc = cursor.number<std::uint32_t>();
  if (!cursor.ok() || start == 0) return definitions;
  definitions.is_damaged =
      start > footer_at ||
      (crc != 0 && crc != crc32(file.substr(start, footer_at + footer_size - sizeof crc - start)));
  if (definitions.is_damaged) return definitions;
  std::string_view rest = file.substr(start, footer_at - start);
  for (auto record = next_record(rest); record; record = next_record(rest = record->rest)) {
    if (record->is(Opcode::schema)) {
      if (auto schema = parse_schema(record->content))
        definitions.schemas.insert_or_assign(schema->id, *schema);
    } else if (record->is(Opcode::channel)) {
      if (auto channel = parse_channel(record->content))
        definitions.channels.insert_or_assign(channel->id, *channel);
    }
  }
  return definitions;
}

}  // namespace tessera::mcap
