#include "tessera/poses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

constexpr std::int64_t period_ns = pose_period.count();

/// Bodies that drive and turn, some of which stand still for a while.
[[nodiscard]] std::vector<BodyPose> moved(std::size_t bodies, int frame) {
  std::vector<BodyPose> poses(bodies);
  for (std::size_t body = 0; body < bodies; ++body) {
    const double time = body % 3 == 0 && frame > 20 ? 20 : frame, own = static_cast<double>(body);
    const double angle = 0.1 * time + own;
    poses[body] = {{std::sin(0.05 * time) * own, -own, 1e-3 * time},
                   {std::cos(angle), 0, std::sin(angle) * 0.6, std::sin(angle) * 0.8}};
  }
  return poses;
}

[[nodiscard]] double angle_between(const BodyPose& one, const BodyPose& other) {
  double product = 0;
  for (std::size_t at = 0; at < 4; ++at) product += one.rotation[at] * other.rotation[at];
  return 2 * std::acos(std::min(1.0, std::abs(product)));
}

TEST(Poses, ComeBackWithinHalfAStep) {
  constexpr std::size_t bodies = 17;
  PoseEncoder encoder(bodies);
  PoseDecoder decoder(bodies);
  for (int frame = 0; frame < 200; ++frame) {
    const std::vector<BodyPose> poses = moved(bodies, frame);
    ASSERT_TRUE(decoder.take(encoder.encode(frame * period_ns, poses)));
    ASSERT_TRUE(decoder.known());
    for (std::size_t body = 0; body < bodies; ++body) {
      const BodyPose read = pose_of(decoder.poses()[body]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(read.position_m[axis], poses[body].position_m[axis], 0.5e-4 + 1e-12);
      EXPECT_LT(angle_between(read, poses[body]), 3e-4);
    }
  }
}

TEST(Poses, OfBodiesThatRestTakeNoFrameExceptTheWholeOneOfEachSecond) {
  PoseEncoder encoder(4);
  int frames = 0;
  for (int frame = 0; frame < 250; ++frame)
    if (!encoder.encode(frame * period_ns, std::vector<BodyPose>(4)).empty()) ++frames;
  EXPECT_EQ(frames, 10);  // of ten seconds
}

TEST(Poses, AreKnownFromTheFirstWholeFrameOnAndNeverWrong) {
  constexpr std::size_t bodies = 5;
  PoseEncoder encoder(bodies);
  std::vector<std::string> frames;
  std::vector<std::vector<RoundedPose>> truth;
  PoseDecoder all(bodies);
  for (int frame = 0; frame < 100; ++frame) {
    frames.emplace_back(encoder.encode(frame * period_ns, moved(bodies, frame)));
    ASSERT_TRUE(all.take(frames.back()));
    truth.push_back(all.poses());
  }
  // Each frame is lost once, and a reader begins at each.
  for (std::size_t special = 0; special < frames.size(); ++special) {
    PoseDecoder begins(bodies), loses(bodies);
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
      EXPECT_TRUE(frame < special || begins.take(frames[frame]));
      EXPECT_TRUE(frame == special || loses.take(frames[frame]));
      for (const PoseDecoder* reader : {&begins, &loses})
        EXPECT_TRUE(frame == special || !reader->known() || reader->poses() == truth[frame]);
      EXPECT_TRUE(frame < special + 25 || (begins.known() && loses.known()));
    }
  }
}

TEST(Poses, ThatAreNotFiniteLeaveTheBodyWhereItWas) {
  PoseEncoder encoder(2);
  PoseDecoder decoder(2);
  std::vector<BodyPose> poses(2);
  poses[0].position_m = {1, 2, 3};
  ASSERT_TRUE(decoder.take(encoder.encode(0, poses)));
  const std::vector<RoundedPose> before = decoder.poses();
  poses[0].position_m[1] = std::numeric_limits<double>::quiet_NaN();
  poses[1].rotation = {0, 0, 0, 0};
  EXPECT_TRUE(encoder.encode(period_ns, poses).empty());
  poses[0].position_m = {1e300, -1e300, 0};
  ASSERT_TRUE(decoder.take(encoder.encode(2 * period_ns, poses)));
  EXPECT_EQ(decoder.poses()[0].steps[0], 1'000'000'000'000);
  EXPECT_EQ(decoder.poses()[1], before[1]);
}

TEST(Poses, FromDamagedBytesAreRefusedOrWithinTheirLimits) {
  constexpr std::size_t bodies = 6;
  std::mt19937_64 random(7);
  for (int run = 0; run < 3000; ++run) {
    PoseEncoder encoder(bodies);
    PoseDecoder decoder(bodies);
    for (int frame = 0; frame < 4; ++frame) {
      std::string bytes(encoder.encode(frame * period_ns, moved(bodies, frame)));
      if (frame > 0) bytes[random() % bytes.size()] = static_cast<char>(random());
      if (random() % 4 == 0) bytes.resize(random() % bytes.size());
      EXPECT_TRUE(decoder.take(bytes) || !decoder.known());
      if (!decoder.known()) continue;
      for (const RoundedPose& pose : decoder.poses())
        for (std::size_t at = 3; at < 7; ++at) EXPECT_LE(std::abs(pose.steps[at]), 8191);
    }
  }
}

/// The page decodes the same bytes (studio/web/tests/live/world.test.ts).
TEST(Poses, HaveTheseBytes) {
  PoseEncoder encoder(3);
  std::vector<BodyPose> poses(3);
  poses[0].position_m = {1.5, -2, 0.03};
  poses[2].rotation = {0, 0, 0.6, -0.8};
  std::vector<std::string> frames;
  for (int frame = 0; frame < 3; ++frame) {
    std::string& hex = frames.emplace_back();
    for (const char byte : encoder.encode(frame * period_ns, poses))
      hex += {"0123456789abcdef"[static_cast<std::uint8_t>(byte) >> 4U], "0123456789abcdef"[byte & 15]};
    poses[0].position_m[0] += 0.0123;
    poses[2].rotation = {0.0499, 0, 0.5993, -0.799};
    if (frame == 1) poses[1].position_m[1] = 100'000;
  }
  EXPECT_EQ(frames, (std::vector<std::string>{"010000000fb0ea01bfb802d804fe7f0008fe7f0060e64cb166",
                                              "0001000001f6010168b2060b12", "0002000001f601000280a8d6b907"}));
}

TEST(Poses, WholeFrameListsEveryBody) {
  PoseEncoder encoder(3);
  const std::string frame(encoder.encode(0, std::vector<BodyPose>(3)));
  PoseDecoder more(4), fewer(2);
  EXPECT_FALSE(more.take(frame));
  EXPECT_FALSE(fewer.take(frame));
  EXPECT_LE(frame.size(), PoseEncoder::longest_frame(3));
}

}  // namespace
}  // namespace tessera::testing
