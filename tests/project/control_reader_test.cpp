#include "project/process/control_reader.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "tessera/monitor.hpp"

namespace tessera::project {
namespace {

std::string piece(const std::string& bytes) {
  return "{\"recording_bytes\":" + std::to_string(bytes.size()) + "}\n" + bytes;
}

std::string scene(const std::string& bytes) {
  return "{\"scene_bytes\":" + std::to_string(bytes.size()) + ",\"from\":0,\"total\":4}\n" + bytes;
}

}  // namespace

TEST(ControlReader, MessagesAreTheSameHoweverTheirBytesAreCut) {
  const std::string all = "{\"pid\":1}\n" + piece("a line\n{}\n") + "no JSON\n" + scene("glTF") + piece("") +
                          "{\"ended\":true}\n";
  for (std::size_t size = 1; size <= all.size(); ++size) {
    ControlReader reader;
    std::vector<ControlMessage> read;
    for (std::size_t at = 0; at < all.size(); at += size) {
      reader.add(std::string_view(all).substr(at, size));
      while (std::optional<ControlMessage> message = reader.next()) read.push_back(std::move(*message));
    }
    ASSERT_EQ(read.size(), 6U) << size;
    EXPECT_EQ(read[0].line, "{\"pid\":1}");
    EXPECT_EQ(std::get<Snapshot>(read[0].content.value()).pid, 1);
    EXPECT_EQ(read[0].bytes, "");
    EXPECT_TRUE(std::holds_alternative<PieceHead>(read[1].content.value()));
    EXPECT_EQ(read[1].bytes, "a line\n{}\n");
    EXPECT_EQ(read[2].line, "no JSON");
    EXPECT_FALSE(read[2].content);
    EXPECT_EQ(std::get<SceneHead>(read[3].content.value()).total, 4U);
    EXPECT_EQ(read[3].bytes, "glTF");
    EXPECT_EQ(read[4].bytes, "");
    EXPECT_TRUE(std::holds_alternative<ControllerHasEnded>(read[5].content.value()));
    EXPECT_FALSE(reader.exceeds_limits());
  }
}

TEST(ControlReader, AMessageWaitsForItsLastByte) {
  ControlReader reader;
  const std::string all = piece("abc");
  reader.add(std::string_view(all).substr(0, all.size() - 1));
  EXPECT_FALSE(reader.next());
  reader.add("c");
  EXPECT_EQ(reader.next().value().bytes, "abc");
  EXPECT_FALSE(reader.next());
}

TEST(ControlReader, AHeadThatAnnouncesMoreThanAControllerSendsIsTheLast) {
  for (const char* member : {"recording_bytes", "scene_bytes"}) {
    const auto head = [&](std::size_t bytes) {
      return std::string("{\"") + member + "\":" + std::to_string(bytes) + "}\n";
    };
    ControlReader reader;
    reader.add(head(longest_piece) + std::string(longest_piece, 'a'));
    EXPECT_EQ(reader.next().value().bytes.size(), longest_piece);
    EXPECT_FALSE(reader.exceeds_limits());
    reader.add(head(longest_piece + 1) + std::string(longest_piece + 1, 'a') + "\n{\"ended\":true}\n");
    EXPECT_FALSE(reader.next()) << member;
    EXPECT_TRUE(reader.exceeds_limits()) << member;
    EXPECT_FALSE(reader.next()) << member;
  }
}

TEST(ControlReader, HoldsAtMost64MegabytesWithoutAMessage) {
  ControlReader reader;
  const std::string megabyte(std::size_t{1} << 20U, 'x');
  for (int count = 0; count < 64; ++count) reader.add(megabyte);
  EXPECT_FALSE(reader.exceeds_limits());
  reader.add("\n");
  EXPECT_TRUE(reader.exceeds_limits());
  EXPECT_EQ(reader.next().value().line.size(), 64 * megabyte.size());
  EXPECT_FALSE(reader.exceeds_limits()) << "all is read";
}

}  // namespace tessera::project
