#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "server/recordings/pose_track.hpp"

namespace tessera::server_test {
namespace {

using server::PoseTrack;

[[nodiscard]] std::string bytes_of(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, count = 0;
  for (const char letter : base64) {
    if (letter == '=') break;
    bits = bits << 6U | static_cast<unsigned>(digits.find(letter));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xffU);
  }
  return bytes;
}

/// A recording of two bodies, of which the first drives.
struct PosesOfAPage : ::testing::Test {
  Recording header;
  PoseEncoder recorder{2};
  PosesOfAPage() { header.scene = {"0123456789abcdef", {{"rover", "robot"}, {"stone", ""}}, {}}; }

  [[nodiscard]] static std::vector<BodyPose> poses(int frame) {
    std::vector<BodyPose> all(2);
    all[0].position_m = {0.01 * frame, 0, 0};
    return all;
  }
  [[nodiscard]] Recording::Entry entry(int frame) {
    Recording::Entry entry;
    entry.event.time_ns = frame * pose_period.count();
    entry.event.origin = system_instance << 8U | static_cast<std::uint32_t>(Event::Kind::poses);
    entry.text = recorder.encode(entry.event.time_ns, poses(frame));
    return entry;
  }
};

TEST_F(PosesOfAPage, AreRightHoweverFewFramesAreSent) {
  PoseTrack track;
  EXPECT_TRUE(track.scene().is_null());
  track.begin(header);
  EXPECT_EQ(track.scene(), nlohmann::json::parse(R"({"hash": "0123456789abcdef",
                                                     "bodies": [["rover", "robot"], ["stone", ""]]})"));
  PoseDecoder page(2), late(2);
  for (int frame = 0; frame < 200; ++frame) {
    track.take(entry(frame));
    if (frame % 7 != 0) continue;
    const auto sent = track.next_frame();
    ASSERT_TRUE(sent);
    ASSERT_TRUE(page.take(bytes_of(sent->bytes)));
    ASSERT_TRUE(page.known());
    EXPECT_EQ(page.poses()[0], *rounded(poses(frame)[0]));
    EXPECT_FALSE(track.next_frame()) << "nothing new";
    // A page that is opened now gets the present poses, and goes on with the next frames.
    EXPECT_TRUE(frame != 70 || late.take(bytes_of(track.last_whole()->bytes)));
    EXPECT_TRUE(frame <= 70 || late.take(bytes_of(sent->bytes)));
    EXPECT_TRUE(frame < 70 || late.poses() == page.poses());
  }
}

TEST_F(PosesOfAPage, GoOnInTheNextSegmentOfTheSameRun) {
  PoseTrack track;
  track.begin(header);
  track.take(entry(0));
  ASSERT_TRUE(track.next_frame());
  track.begin(header);
  track.take(entry(1));  // differences
  EXPECT_TRUE(track.next_frame());
}

TEST_F(PosesOfAPage, AreNotToldBeforeTheyAreKnown) {
  PoseTrack track;
  track.begin(header);
  static_cast<void>(entry(0));
  track.take(entry(1));
  EXPECT_FALSE(track.next_frame());
  EXPECT_FALSE(track.last_whole());
  for (int frame = 2; frame < 30; ++frame) track.take(entry(frame));
  EXPECT_TRUE(track.next_frame());
}

TEST_F(PosesOfAPage, AreNoneInARecordingWithoutAWorld) {
  PoseTrack track;
  track.begin(Recording{});
  track.take(entry(0));
  EXPECT_TRUE(track.scene().is_null());
  EXPECT_FALSE(track.next_frame());
}

TEST(Base64, IsThatOfRfc4648) {
  for (const auto& [bytes, text] : std::vector<std::pair<std::string, std::string>>{
           {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"\xff\xef\xbe", "/+++"}})
    EXPECT_EQ(server::base64_of(bytes), text);
}

}  // namespace
}  // namespace tessera::server_test
