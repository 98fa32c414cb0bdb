#include "mcap/reader.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "made_file.hpp"
#include "mcap/byte_order.hpp"
#include "mcap/compression.hpp"
#include "mcap/crc32.hpp"

namespace tessera::mcap::test {
namespace {

void put(std::string& file, std::uint8_t opcode, std::string_view content) {
  put_number(file, opcode);
  put_number(file, static_cast<std::uint64_t>(content.size()));
  file += content;
}

std::string message_record(std::string_view data) {
  std::string content, record;
  put_number(content, std::uint16_t{7});
  put_number(content, std::uint32_t{0});
  put_number(content, std::uint64_t{1});
  put_number(content, std::uint64_t{1});
  put(record, 0x05, content + std::string(data));
  return record;
}

/// A file as another program might write it: without index, its definitions inside the chunk.
std::string foreign_file(std::string_view compression, std::uint64_t size_off = 0) {
  std::string channel, records, file(magic);
  put_number(channel, std::uint16_t{7});
  put_number(channel, std::uint16_t{0});
  put_text(channel, "/scan");
  put_text(channel, "cdr");
  put_map(channel, {});
  put(records, 0x04, channel + "a field of a later version");
  records += message_record("first");
  put(records, 0x7e, "a record of a later version");
  put(records, 0x80, "a record of a program's own");
  records += message_record(std::string(100'000, 'x'));
  const std::string small = *compress(records, compression);
  std::string chunk;
  put_number(chunk, std::uint64_t{1});
  put_number(chunk, std::uint64_t{1});
  put_number(chunk, records.size() + size_off);
  put_number(chunk, crc32(records));
  put_text(chunk, compression);
  put_number(chunk, static_cast<std::uint64_t>(small.size()));
  put(file, 0x01, std::string(8, '\0'));
  put(file, 0x90, "something unknown");
  put(file, 0x06, chunk + small);
  put(file, 0x0f, std::string(4, '\0'));
  put(file, 0x02, std::string(20, '\0'));
  return file + std::string(magic);
}

TEST(McapReader, ReadsEachCompressionAndSkipsWhatItDoesNotKnow) {
  for (const std::string_view compression : {zstd, lz4, uncompressed}) {
    const Contents contents = contents_of(foreign_file(compression));
    EXPECT_TRUE(contents.condition.is_whole()) << compression << ": " << contents.condition.told();
    ASSERT_EQ(contents.messages.size(), 2U) << compression;
    EXPECT_EQ(contents.messages[0], "/scan: first");
    EXPECT_EQ(contents.messages[1].size(), 7U + 100'000U);
  }
}

TEST(McapReader, LeavesOutChunksWhoseSizeIsNotWhatTheyContain) {
  for (const std::string_view compression : {zstd, lz4, uncompressed})
    for (const std::uint64_t off :
         {std::uint64_t{1}, std::uint64_t{1} << 60U, ~std::uint64_t{0}, ~std::uint64_t{100'000}}) {
      const Contents contents = contents_of(foreign_file(compression, off));
      EXPECT_TRUE(contents.messages.empty()) << compression << off;
      EXPECT_EQ(contents.condition.damaged, 1U) << compression << off;
    }
}

TEST(McapReader, RecordThatClaimsMoreThanTheFileEndsIt) {
  std::string file = made_file(1);
  file.resize(file.find("run") - 4 - 9);  // the record of metadata, and all behind it
  put_number(file, std::uint8_t{0x0c});
  put_number(file, std::uint64_t{1} << 60U);
  const Contents contents = contents_of(file);
  EXPECT_EQ(contents.messages.size(), 3U);
  EXPECT_FALSE(contents.condition.is_complete);
}

TEST(McapReader, TellsOtherFilesApart) {
  EXPECT_FALSE(contents_of("").condition.is_mcap);
  EXPECT_FALSE(contents_of("TESSREC1").condition.is_mcap);
  EXPECT_TRUE(contents_of(magic).condition.is_mcap);
  EXPECT_FALSE(contents_of(magic).condition.is_complete);
}

}  // namespace
}  // namespace tessera::mcap::test
