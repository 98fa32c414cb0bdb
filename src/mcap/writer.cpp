#include "mcap/writer.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>

#include "mcap/byte_order.hpp"
#include "mcap/compression.hpp"
#include "mcap/crc32.hpp"

namespace tessera::mcap {
namespace {

void put_record(std::string& to, Opcode opcode, std::string_view content) {
  put_number(to, opcode);
  put_number(to, static_cast<std::uint64_t>(content.size()));
  to += content;
}

std::string content_of(const Schema& schema) {
  std::string content;
  put_number(content, schema.id);
  put_text(content, schema.name);
  put_text(content, schema.encoding);
  put_text(content, schema.data);
  return content;
}

std::string content_of(const Channel& channel) {
  std::string content;
  put_number(content, channel.id);
  put_number(content, channel.schema);
  put_text(content, channel.topic);
  put_text(content, channel.encoding);
  put_map(content, channel.metadata);
  return content;
}

}  // namespace

Writer::Writer(std::string_view profile, std::string_view library) : out_(magic) {
  std::string content;
  put_text(content, profile);
  put_text(content, library);
  put(Opcode::header, content);
}

void Writer::put(Opcode opcode, std::string_view content) { put_record(out_, opcode, content); }

std::uint16_t Writer::add_schema(std::string name, std::string encoding, std::string data) {
  assert(schemas_.size() < std::numeric_limits<std::uint16_t>::max());
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_.push_back({id, std::move(name), std::move(encoding), std::move(data)});
  put(Opcode::schema, content_of(schemas_.back()));
  return id;
}

std::uint16_t Writer::add_channel(Channel channel) {
  assert(channels_.size() <= std::numeric_limits<std::uint16_t>::max());
  channel.id = static_cast<std::uint16_t>(channels_.size());
  channels_.push_back(std::move(channel));
  counts_.push_back(0);
  put(Opcode::channel, content_of(channels_.back()));
  return channels_.back().id;
}

void Writer::attach(const Attachment& attachment) {
  close_chunk();
  std::string content;
  put_number(content, attachment.log_ns);
  put_number(content, std::uint64_t{0});  // when the file was created is unknown
  put_text(content, attachment.name);
  put_text(content, attachment.media_type);
  put_number(content, static_cast<std::uint64_t>(attachment.data.size()));
  content += attachment.data;
  put_number(content, crc32(content));
  const std::uint64_t offset = at();
  put(Opcode::attachment, content);
  attachments_.push_back({offset, at() - offset, attachment.log_ns, attachment.data.size(), attachment.name,
                          attachment.media_type});
}

void Writer::add_metadata(const Metadata& metadata) {
  std::string content;
  put_text(content, metadata.name);
  put_map(content, metadata.entries);
  const std::uint64_t offset = at();
  put(Opcode::metadata, content);
  metadata_.push_back({offset, at() - offset, metadata.name});
}

void Writer::write(std::uint16_t channel, std::uint64_t log_ns, std::uint64_t publish_ns,
                   std::string_view data) {
  start_ns_ = chunk_.empty() ? log_ns : std::min(start_ns_, log_ns);
  end_ns_ = chunk_.empty() ? log_ns : std::max(end_ns_, log_ns);
  index_[channel].emplace_back(log_ns, chunk_.size());
  put_number(chunk_, Opcode::message);
  put_number(chunk_, std::uint64_t{22} + data.size());
  put_number(chunk_, channel);
  put_number(chunk_, static_cast<std::uint32_t>(counts_[channel]++));
  put_number(chunk_, log_ns);
  put_number(chunk_, publish_ns);
  chunk_ += data;
}

void Writer::close_chunk() {
  if (chunk_.empty()) return;
  const std::optional<std::string> small = compress(chunk_, zstd);
  const std::string_view compression = small ? zstd : uncompressed;
  const std::string& records = small ? *small : chunk_;
  std::string content;
  put_number(content, start_ns_);
  put_number(content, end_ns_);
  put_number(content, static_cast<std::uint64_t>(chunk_.size()));
  put_number(content, crc32(chunk_));
  put_text(content, compression);
  put_number(content, static_cast<std::uint64_t>(records.size()));
  content += records;
  const std::uint64_t offset = at();
  put(Opcode::chunk, content);
  ChunkEntry entry{start_ns_, end_ns_,        offset,        at() - offset,    {},
                   0,         records.size(), chunk_.size(), small.has_value()};
  put_message_indexes(entry);
  chunks_.push_back(std::move(entry));
  chunk_.clear();
  index_.clear();
}

void Writer::put_message_indexes(ChunkEntry& entry) {
  const std::uint64_t first = at();
  for (auto& [channel, messages] : index_) {
    std::ranges::stable_sort(messages, {}, [](const auto& message) { return message.first; });
    std::string content;
    put_number(content, channel);
    put_number(content, static_cast<std::uint32_t>(16 * messages.size()));
    for (const auto& [time_ns, offset] : messages) {
      put_number(content, time_ns);
      put_number(content, offset);
    }
    entry.message_indexes.emplace_back(channel, at());
    put(Opcode::message_index, content);
  }
  entry.indexes_length = at() - first;
}

void Writer::put_statistics() {
  std::uint64_t messages = 0, start_ns = 0, end_ns = 0;
  std::string counts;
  for (std::size_t channel = 0; channel < counts_.size(); ++channel) {
    if (counts_[channel] == 0) continue;
    messages += counts_[channel];
    put_number(counts, static_cast<std::uint16_t>(channel));
    put_number(counts, counts_[channel]);
  }
  for (const ChunkEntry& chunk : chunks_) {
    start_ns = &chunk == &chunks_.front() ? chunk.start_ns : std::min(start_ns, chunk.start_ns);
    end_ns = std::max(end_ns, chunk.end_ns);
  }
  std::string content;
  put_number(content, messages);
  put_number(content, static_cast<std::uint16_t>(schemas_.size()));
  put_number(content, static_cast<std::uint32_t>(channels_.size()));
  put_number(content, static_cast<std::uint32_t>(attachments_.size()));
  put_number(content, static_cast<std::uint32_t>(metadata_.size()));
  put_number(content, static_cast<std::uint32_t>(chunks_.size()));
  put_number(content, start_ns);
  put_number(content, end_ns);
  put_text(content, counts);
  put(Opcode::statistics, content);
}

void Writer::put_summary() {
  std::string offsets;
  const auto group = [&](Opcode opcode, auto write) {
    const std::uint64_t start = at();
    write();
    if (at() == start) return;
    std::string content;
    put_number(content, opcode);
    put_number(content, start);
    put_number(content, at() - start);
    put_record(offsets, Opcode::summary_offset, content);
  };
  group(Opcode::schema, [&] {
    for (const Schema& schema : schemas_) put(Opcode::schema, content_of(schema));
  });
  group(Opcode::channel, [&] {
    for (const Channel& channel : channels_) put(Opcode::channel, content_of(channel));
  });
  group(Opcode::statistics, [&] { put_statistics(); });
  group(Opcode::chunk_index, [&] {
    for (const ChunkEntry& chunk : chunks_) {
      std::string content;
      put_number(content, chunk.start_ns);
      put_number(content, chunk.end_ns);
      put_number(content, chunk.offset);
      put_number(content, chunk.length);
      put_number(content, static_cast<std::uint32_t>(10 * chunk.message_indexes.size()));
      for (const auto& [channel, offset] : chunk.message_indexes) {
        put_number(content, channel);
        put_number(content, offset);
      }
      put_number(content, chunk.indexes_length);
      put_text(content, chunk.is_compressed ? zstd : uncompressed);
      put_number(content, chunk.compressed);
      put_number(content, chunk.uncompressed);
      put(Opcode::chunk_index, content);
    }
  });
  group(Opcode::attachment_index, [&] {
    for (const AttachmentEntry& one : attachments_) {
      std::string content;
      put_number(content, one.offset);
      put_number(content, one.length);
      put_number(content, one.log_ns);
      put_number(content, std::uint64_t{0});
      put_number(content, one.size);
      put_text(content, one.name);
      put_text(content, one.media_type);
      put(Opcode::attachment_index, content);
    }
  });
  group(Opcode::metadata_index, [&] {
    for (const MetadataEntry& one : metadata_) {
      std::string content;
      put_number(content, one.offset);
      put_number(content, one.length);
      put_text(content, one.name);
      put(Opcode::metadata_index, content);
    }
  });
  const std::uint64_t offsets_start = at();
  out_ += offsets;
  // The footer begins with the position of the summary, which its check sum covers.
  put_number(out_, Opcode::footer);
  put_number(out_, std::uint64_t{20});
  put_number(out_, taken_);
  put_number(out_, offsets_start);
}

void Writer::finish() {
  close_chunk();
  std::string content;
  put_number(content, crc32(out_, crc_));
  put(Opcode::data_end, content);
  const std::string data = take();
  put_summary();
  put_number(out_, crc32(out_));
  out_ += magic;
  out_.insert(0, data);
  taken_ -= data.size();
}

std::string Writer::take() {
  crc_ = crc32(out_, crc_);
  taken_ += out_.size();
  return std::exchange(out_, {});
}

}  // namespace tessera::mcap
