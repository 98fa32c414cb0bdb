#include "mcap/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "mcap/byte_order.hpp"
#include "mcap/compression.hpp"
#include "mcap/crc32.hpp"
#include "mcap/record_parser.hpp"

namespace tessera::mcap {
namespace {

/// The number of damaged chunks that are decompressed while the next whole one is looked for. It bounds the time
/// for a file that was made to waste it.
constexpr std::size_t most_attempts = 4096;

class Reading {
 public:
  Reading(std::string_view file, const Receivers& receivers)
      : file_(file), receivers_(receivers), known_(summary_of(file)) {}

  Condition read() {
    condition_.is_mcap = file_.starts_with(magic);
    if (!condition_.is_mcap) return condition_;
    at_ = sound_ = magic.size();
    while (at_ < file_.size() && !condition_.is_complete)
      if (!take_record()) go_to_next_chunk();
    return condition_;
  }

 private:
  /// false: there is no whole record, or it is damaged.
  bool take_record() {
    const std::optional<Record> record = next_record(file_.substr(at_));
    if (!record || !take(*record)) return false;
    at_ = file_.size() - record->rest.size();
    return true;
  }

  bool take(const Record& record) {
    if (record.is(Opcode::chunk)) return take_chunk(record.content);
    if (record.is(Opcode::message_index)) return is_message_index(record.content);
    if (record.is(Opcode::attachment)) return take_attachment(record.content);
    if (record.is(Opcode::metadata)) return take_metadata(record.content);
    if (record.is(Opcode::data_end)) return take_data_end(record.content);
    if (record.is(Opcode::footer)) {
      condition_.is_complete = record.rest == magic;
      if ((known_.is_damaged || !is_after_data_) && condition_.damaged == 0) ++condition_.damaged;
      return condition_.is_complete;
    }
    return take_message_or_definition(record);
  }

  /// Records beside chunks have no check sum of their own, but all bytes up to here have one.
  bool take_data_end(std::string_view content) {
    is_after_data_ = content.size() == sizeof(std::uint32_t);
    const auto crc = Cursor(content).number<std::uint32_t>();
    const bool is_changed = is_after_data_ && crc != 0 && crc != crc32(file_.substr(0, at_));
    if (is_changed && condition_.damaged == 0) ++condition_.damaged;
    return is_after_data_;
  }

  bool take_message_or_definition(const Record& record) {
    if (record.is(Opcode::schema)) {
      auto schema = parse_schema(record.content);
      if (schema && schema->id != 0 && !is_after_data_) known_.schemas.try_emplace(schema->id, *schema);
      return schema.has_value();
    }
    if (record.is(Opcode::channel)) {
      auto channel = parse_channel(record.content);
      if (channel && !is_after_data_) known_.channels.try_emplace(channel->id, *channel);
      return channel.has_value();
    }
    if (!record.is(Opcode::message)) {
      // Nothing that a reader from the beginning needs; but a chunk whose kind was changed looks like this, too.
      if (!is_after_data_ && !record.is(Opcode::header)) tell_of_gap();
      return true;
    }
    if (!is_in_chunk_ && condition_.chunks > 0) return false;
    const std::optional<Message> message = parse_message(record.content);
    if (message) receive(*message);
    return message.has_value();
  }

  void tell_of_gap() const {
    if (receivers_.gap) receivers_.gap();
  }

  void receive(const Message& message) {
    const auto channel = known_.channels.find(message.channel);
    if (channel == known_.channels.end()) {
      ++condition_.unknown;
      return;
    }
    ++condition_.messages;
    if (!receivers_.message) return;
    const auto schema = known_.schemas.find(channel->second.schema);
    receivers_.message(
        {message, channel->second, schema == known_.schemas.end() ? nullptr : &schema->second});
  }

  bool take_chunk(std::string_view content) {
    const std::optional<Chunk> chunk = parse_chunk(content);
    if (!chunk) return false;
    const std::optional<std::string> records = decompress(chunk->records, chunk->compression, chunk->size);
    if (!records || (chunk->crc != 0 && chunk->crc != crc32(*records))) return false;
    ++condition_.chunks;
    sound_ = static_cast<std::size_t>(chunk->records.data() + chunk->records.size() - file_.data());
    std::string_view rest = *records;
    is_in_chunk_ = true;
    for (auto record = next_record(rest); record; record = next_record(rest = record->rest))
      if (!take_message_or_definition(*record)) break;
    is_in_chunk_ = false;
    return true;
  }

  bool take_attachment(std::string_view content) {
    const std::optional<Attachment> attachment = parse_attachment(content);
    if (attachment && receivers_.attachment) receivers_.attachment(*attachment);
    return attachment.has_value();
  }

  bool take_metadata(std::string_view content) {
    const std::optional<Metadata> metadata = parse_metadata(content);
    if (metadata && receivers_.metadata) receivers_.metadata(*metadata);
    return metadata.has_value();
  }

  /// Searches behind the last place that is surely sound, because a damaged length may have led anywhere.
  void go_to_next_chunk() {
    tell_of_gap();
    // A record that ends behind the file is one that was cut off, unless whole chunks follow.
    const std::optional<Record> last = next_record(file_.substr(at_));
    const bool is_last = !last || (last->is(Opcode::footer) && magic.starts_with(last->rest));
    for (std::size_t from = std::max(sound_, searched_);
         (from = file_.find(static_cast<char>(Opcode::chunk), from)) != std::string_view::npos; ++from) {
      searched_ = from + 1;
      if (from == at_ || !is_chunk(from)) continue;
      ++condition_.damaged;
      at_ = from;
      return;
    }
    condition_.damaged += is_last && !known_.is_complete ? 0 : 1;
    condition_.is_complete = known_.is_complete;
    at_ = file_.size();
  }

  [[nodiscard]] bool is_chunk(std::size_t from) {
    const std::optional<Record> record = next_record(file_.substr(from));
    const std::optional<Chunk> chunk = record ? parse_chunk(record->content) : std::nullopt;
    if (!chunk || attempts_ >= most_attempts) return false;
    const std::optional<std::string> records = decompress(chunk->records, chunk->compression, chunk->size);
    const bool is_sound = records && (chunk->crc == 0 || chunk->crc == crc32(*records));
    if (!is_sound) ++attempts_;
    return is_sound;
  }

  std::string_view file_;
  const Receivers& receivers_;
  Definitions known_;
  Condition condition_;
  std::size_t at_ = 0, sound_ = 0, searched_ = 0, attempts_ = 0;
  bool is_after_data_ = false, is_in_chunk_ = false;
};

}  // namespace

std::string Condition::told() const {
  std::string text;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (!is_complete) add("its end is missing: it was cut off, or is still being written");
  if (damaged > 0) add(fmt::format("{} damaged place{} left out", damaged, damaged == 1 ? " was" : "s were"));
  if (unknown > 0) add(fmt::format("{} messages of unknown channels were left out", unknown));
  return text;
}

Condition read(std::string_view file, const Receivers& receivers) { return Reading(file, receivers).read(); }

}  // namespace tessera::mcap
