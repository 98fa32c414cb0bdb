#include "mcap/writer.hpp"

#include <gtest/gtest.h>

#include "made_file.hpp"
#include "mcap/crc32.hpp"

namespace tessera::mcap::test {
namespace {

TEST(Crc32, IsThatOfZlibHoweverTheBytesAreDivided) {
  EXPECT_EQ(crc32("123456789"), 0xcbf43926U);
  EXPECT_EQ(crc32("6789", crc32("12345")), 0xcbf43926U);
  EXPECT_EQ(crc32(""), 0U);
}

TEST(McapWriter, FileIsReadAsItWasWritten) {
  const Contents contents = contents_of(made_file(4));
  EXPECT_TRUE(contents.condition.is_whole()) << contents.condition.told();
  EXPECT_EQ(contents.condition.chunks, 4U);
  ASSERT_EQ(contents.messages.size(), 12U);
  for (std::uint64_t number = 0; number < 12; ++number) EXPECT_EQ(contents.messages[number], message(number));
  EXPECT_EQ(contents.attachments, std::vector<std::string>{"spec.yaml: system: nothing\n"});
  EXPECT_EQ(contents.metadata, std::vector<std::string>{"run"});
}

TEST(McapWriter, ChannelAndTimesAreThoseOfTheMessage) {
  std::vector<Message> messages;
  std::vector<Channel> channels;
  std::vector<Schema> schemas;
  read(made_file(1), {.message = [&](const ReadMessage& one) {
         messages.push_back(one.message);
         channels.push_back(one.channel);
         schemas.push_back(one.schema == nullptr ? Schema{} : *one.schema);
       }});
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(channels[0].metadata.at("buffer"), "robot.a");
  EXPECT_EQ(schemas[0].name, "Text");
  EXPECT_EQ(schemas[1].name, "");
  EXPECT_EQ(messages[2].sequence, 1U);
  EXPECT_EQ(messages[2].log_ns, 2000U);
  EXPECT_EQ(messages[2].publish_ns, 2001U);
}

}  // namespace
}  // namespace tessera::mcap::test
