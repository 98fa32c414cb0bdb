#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "bag/bag_reader.hpp"
#include "bag/bag_writer.hpp"
#include "bag/raw_channel.hpp"
#include "made_run.hpp"
#include "mcap/reader.hpp"

/// A recording becomes a bag and is read from it again.
namespace tessera::bag::test {
namespace {

std::string bag_of(const Recording& recording, std::size_t entries_per_chunk) {
  BagWriter writer(recording, background(), "a test");
  std::string bytes;
  for (std::size_t index = 0; index < recording.entries.size(); ++index) {
    writer.add(recording.entries[index]);
    if ((index + 1) % entries_per_chunk == 0) writer.close_chunk();
  }
  writer.end(2);
  writer.finish();
  return bytes + writer.take();
}

bool same(const Recording::Entry& a, const Recording::Entry& b) {
  return std::memcmp(&a.event, &b.event, sizeof a.event) == 0 && a.text == b.text;
}

TEST(Bag, HoldsTheRecording) {
  const Recording recording = made_recording();
  std::string error;
  const std::optional<Bag> bag = read_bag_bytes(bag_of(recording, 9), error);
  ASSERT_TRUE(bag) << error;
  EXPECT_TRUE(bag->condition.is_whole()) << bag->condition.told();
  EXPECT_EQ(bag->differences, std::vector<std::string>());
  EXPECT_EQ(bag->recording.header, header);
  EXPECT_EQ(bag->recording.lost, 2U);
  EXPECT_FALSE(bag->recording.truncated);
  EXPECT_TRUE(std::ranges::equal(bag->recording.entries, recording.entries, same));
}

TEST(Bag, ShowsEachValueAsMessage) {
  std::vector<std::string> topics;
  std::vector<std::string> counts;
  std::vector<double> speeds;
  std::string encodings;
  mcap::read(bag_of(made_recording(), 100), {.message = [&](const mcap::ReadMessage& one) {
               topics.push_back(one.channel.topic);
               if (one.channel.topic == "/robot/base/count") {
                 counts.emplace_back(one.message.data);
                 EXPECT_EQ(one.message.publish_ns, counts.size() % 2 == 1 ? 5U : 6U);
               }
               if (one.channel.topic != "/cmd_vel") return;
               EXPECT_EQ(one.schema->name, "geometry_msgs/msg/Twist");
               ASSERT_EQ(one.message.data.size(), 4U + 6 * 8U);
               std::memcpy(&speeds.emplace_back(), one.message.data.data() + 4, 8);
             }});
  ASSERT_EQ(counts.size(), 16U);
  EXPECT_EQ(counts[15], R"({"value":7})");
  EXPECT_EQ(counts[14], R"({"value":7})");
  EXPECT_EQ(speeds, (std::vector<double>{0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75}));
  EXPECT_EQ(std::ranges::count(topics, "/tf"), 8);
  EXPECT_EQ(std::ranges::count(topics, "/rosout"), 8);
  EXPECT_EQ(std::ranges::count(topics, "/tessera/events"), 24);
}

/// The same messages in a file whose message number `changed` is another; written without this project's conversion.
std::string changed_bag(const std::string& sound, std::size_t changed, bool leave_out) {
  mcap::Writer writer("", "another program");
  std::string bytes;
  std::size_t number = 0;
  std::map<std::uint16_t, std::uint16_t> channels;
  mcap::read(sound,
             {.message =
                  [&](const mcap::ReadMessage& one) {
                    if (!channels.contains(one.channel.id)) {
                      mcap::Channel channel = one.channel;
                      channel.schema =
                          one.schema == nullptr
                              ? 0
                              : writer.add_schema(one.schema->name, one.schema->encoding, one.schema->data);
                      channels[one.channel.id] = writer.add_channel(channel);
                    }
                    std::string data(one.message.data);
                    if (number++ == changed) {
                      if (leave_out) return;
                      // The last byte of a frame of poses is of a quaternion, whose length means nothing.
                      constexpr std::size_t kind_at = 20, position_at = 24 + 5;
                      const bool is_frame = one.channel.encoding == raw_encoding &&
                                            data[kind_at] == static_cast<char>(Event::Kind::poses);
                      char& byte = is_frame ? data[position_at] : data.back();
                      byte = static_cast<char>(byte ^ 1);
                    }
                    writer.write(channels[one.channel.id], one.message.log_ns, one.message.publish_ns, data);
                  },
              .attachment = [&](const mcap::Attachment& one) { writer.attach(one); }});
  writer.finish();
  return bytes + writer.take();
}

TEST(Bag, NoMessageCanBeChangedUnnoticed) {
  MadeRun run;
  for (std::uint32_t number = 0; number < 2; ++number) run.iteration(number);
  const std::string sound = bag_of(run.recording, 5);
  std::string error;
  const std::optional<Bag> copied = read_bag_bytes(changed_bag(sound, SIZE_MAX, false), error);
  ASSERT_TRUE(copied) << error;
  EXPECT_EQ(copied->differences, std::vector<std::string>());
  const std::uint64_t messages = copied->condition.messages;
  ASSERT_GT(messages, 20U);
  for (std::size_t number = 0; number < messages; ++number)
    for (const bool leave_out : {false, true}) {
      // The last one says that the recording ends there; without it, the recording is cut off.
      if (number + 1 == messages) continue;
      const std::optional<Bag> bag = read_bag_bytes(changed_bag(sound, number, leave_out), error);
      ASSERT_TRUE(bag) << error;
      EXPECT_FALSE(bag->differences.empty()) << number << leave_out;
    }
}

TEST(Bag, VerdictsCannotBeChangedUnnoticed) {
  const std::string sound = bag_of(made_recording(), 100);
  for (const std::string changed : {"", "tessera", "tessera.verdicts"}) {
    mcap::Writer writer("", "another program");
    mcap::read(sound, {.attachment = [&](const mcap::Attachment& one) { writer.attach(one); },
                       .metadata =
                           [&](mcap::Metadata one) {
                             if (one.name == changed) one.entries.begin()->second += "x";
                             writer.add_metadata(one);
                           }});
    writer.finish();
    std::string error;
    const std::optional<Bag> bag = read_bag_bytes(writer.take(), error);
    ASSERT_TRUE(bag) << error;
    EXPECT_EQ(bag->differences.size(), changed.empty() ? 0U : 1U) << changed;
  }
}

TEST(Bag, DamageLeavesARecordingThatFitsTheRest) {
  const Recording recording = made_recording();
  const std::string sound = bag_of(recording, 6);
  std::mt19937 random(1);
  for (int turn = 0; turn < 100; ++turn) {
    std::string bytes =
        sound.substr(0, turn % 2 == 0 ? sound.size() : sound.size() / 3 + random() % (sound.size() / 2));
    const std::size_t chunks_at = sound.find("zstd");
    if (turn % 4 != 3)
      bytes[chunks_at + random() % (bytes.size() - chunks_at)] ^= static_cast<char>(1U << random() % 8);
    std::string error;
    const std::optional<Bag> bag = read_bag_bytes(bytes, error);
    ASSERT_TRUE(bag) << turn << error;
    EXPECT_EQ(bag->differences, std::vector<std::string>()) << turn;
    auto known = recording.entries.begin();
    for (const Recording::Entry& entry : bag->recording.entries) {
      known = std::find_if(known, recording.entries.end(),
                           [&](const Recording::Entry& one) { return same(one, entry); });
      ASSERT_NE(known, recording.entries.end()) << turn;
    }
  }
}

TEST(Bag, BagOfAnotherProgramHasNoRecording) {
  mcap::Writer writer("ros2", "another program");
  writer.write(writer.add_channel({0, 0, "/scan", "cdr", {}}), 0, 0, "data");
  writer.finish();
  std::string error;
  EXPECT_FALSE(read_bag_bytes(writer.take(), error));
  EXPECT_NE(error.find("does not contain a recording"), std::string::npos) << error;
}

}  // namespace
}  // namespace tessera::bag::test
