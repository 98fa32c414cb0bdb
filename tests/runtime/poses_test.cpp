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

using Form = PoseEncoder::Form;

/// Frames of both forms.
class Poses : public ::testing::TestWithParam<Form> {};
INSTANTIATE_TEST_SUITE_P(Forms, Poses, ::testing::Values(Form::plain, Form::packed), [](const auto& form) {
  return std::string(form.param == Form::plain ? "Plain" : "Packed");
});

TEST_P(Poses, ComeBackWithinHalfAStep) {
  constexpr std::size_t bodies = 17;
  PoseEncoder encoder(bodies, GetParam());
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

TEST_P(Poses, OfBodiesThatRestTakeNoFrameExceptTheWholeOneOfEachSecond) {
  PoseEncoder encoder(4, GetParam());
  int frames = 0;
  for (int frame = 0; frame < 250; ++frame)
    if (!encoder.encode(frame * period_ns, std::vector<BodyPose>(4)).empty()) ++frames;
  EXPECT_EQ(frames, 10);  // of ten seconds
}

/// Robots of a base and two turning wheels each, whose poses are rough as those of contacts are.
[[nodiscard]] std::vector<BodyPose> rovers(std::size_t robots, int frame, std::mt19937_64& random) {
  std::normal_distribution<double> rough(0, 0.1e-3);
  const auto multiplied = [](const std::array<double, 4>& a, const std::array<double, 4>& b) {
    return std::array<double, 4>{a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                                 a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                                 a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                                 a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
  };
  std::vector<BodyPose> poses;
  for (std::size_t robot = 0; robot < robots; ++robot) {
    const double time = 0.04 * frame, heading = 0.5 * time + static_cast<double>(robot);
    const double x = std::sin(heading) + rough(random), y = -std::cos(heading) + rough(random);
    const std::array<double, 4> turn{std::cos(heading / 2), rough(random), rough(random),
                                     std::sin(heading / 2)};
    poses.push_back({{x, y, 0.03 + rough(random)}, turn});
    for (const double side : {1.0, -1.0}) {
      const double angle = time * (10 - 0.7 * side);
      poses.push_back({{x - side * 0.14 * std::sin(heading), y + side * 0.14 * std::cos(heading), 0.03},
                       multiplied(turn, {std::cos(angle / 2), 0, std::sin(angle / 2), 0})});
    }
  }
  return poses;
}

[[nodiscard]] PoseParents parents_of_rovers(std::size_t robots) {
  PoseParents parents(3 * robots);
  for (std::size_t index = 0; index < parents.size(); ++index)
    if (index % 3 != 0) parents[index] = index / 3 * 3;
  return parents;
}

/// The bar of a day of 50 robots: 1.5 GB are 17.4 kB a second.
TEST(PackedPoses, OfFiftyRoversWithTurningWheelsTakeLessThanSeventeenKilobytesASecond) {
  constexpr std::size_t robots = 50;
  std::mt19937_64 random(3);
  const PoseParents parents = parents_of_rovers(robots);
  PoseEncoder encoder(3 * robots, Form::packed, parents), alone(3 * robots, Form::packed), plain(3 * robots);
  PoseDecoder decoder(3 * robots, parents);
  std::size_t bytes = 0, alone_bytes = 0, plain_bytes = 0;
  for (int frame = 0; frame < 250; ++frame) {
    const std::vector<BodyPose> poses = rovers(robots, frame, random);
    const std::string packed(encoder.encode(frame * period_ns, poses));
    bytes += packed.size();
    alone_bytes += alone.encode(frame * period_ns, poses).size();
    plain_bytes += plain.encode(frame * period_ns, poses).size();
    ASSERT_TRUE(decoder.take(packed));
  }
  EXPECT_LT(bytes / 10, 17'000u);
  EXPECT_LT(bytes, alone_bytes) << "wheels go along with their robot";
  EXPECT_LT(2 * bytes, plain_bytes);
  RecordProperty("bytes_per_second", static_cast<int>(bytes / 10));
  RecordProperty("plain_bytes_per_second", static_cast<int>(plain_bytes / 10));
}

TEST(PackedPoses, HoldTheSameStepsAsPlainOnes) {
  constexpr std::size_t robots = 3;
  std::mt19937_64 random(5);
  // A parent that comes later, or is far away, is none that helps.
  PoseParents parents = parents_of_rovers(robots);
  parents[0] = 5;
  parents[7] = 1;
  PoseEncoder packed(3 * robots, Form::packed, parents), plain(3 * robots);
  PoseDecoder from_packed(3 * robots, parents), from_plain(3 * robots);
  for (int frame = 0; frame < 300; ++frame) {
    // Half of the time they stand still.
    const std::vector<BodyPose> poses = rovers(robots, frame / 40 % 2 == 0 ? frame : 40, random);
    ASSERT_TRUE(from_packed.take(packed.encode(frame * period_ns, poses)));
    ASSERT_TRUE(from_plain.take(plain.encode(frame * period_ns, poses)));
    ASSERT_EQ(from_packed.poses(), from_plain.poses()) << frame;
  }
}

/// A body that jumps about at random defeats what both ends expect.
TEST(PackedPoses, BecomePlainWhereTheyWouldBeLonger) {
  constexpr std::size_t bodies = 1;
  std::mt19937_64 random(9);
  PoseEncoder encoder(bodies, Form::packed);
  PoseDecoder decoder(bodies);
  bool became_plain = false;
  for (int frame = 0; frame < 400; ++frame) {
    std::vector<RoundedPose> poses(bodies);
    for (RoundedPose& pose : poses)
      for (std::size_t at = 0; at < 7; ++at) {
        const std::int64_t limit = at < 3 ? farthest_pose_step : 8191;
        const std::int64_t step = frame % 50 < 48 ? 0 : limit;
        pose.steps[at] = random() % 2 == 0 ? step : -step;
      }
    const std::string bytes(encoder.encode(frame * period_ns, poses));
    ASSERT_LE(bytes.size(), PoseEncoder::longest_frame(bodies));
    became_plain = became_plain || (!bytes.empty() && bytes[0] < 2);
    if (bytes.empty()) continue;
    ASSERT_TRUE(decoder.take(bytes)) << frame;
    for (std::size_t body = 0; body < bodies; ++body)
      for (std::size_t at = 0; at < 3; ++at)
        ASSERT_EQ(decoder.poses()[body].steps[at], poses[body].steps[at]) << frame;
  }
  EXPECT_TRUE(became_plain);
}

TEST_P(Poses, AreKnownFromTheFirstWholeFrameOnAndNeverWrong) {
  constexpr std::size_t bodies = 5;
  PoseEncoder encoder(bodies, GetParam());
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

TEST_P(Poses, ThatAreNotFiniteLeaveTheBodyWhereItWas) {
  PoseEncoder encoder(2, GetParam());
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

TEST_P(Poses, FromDamagedBytesAreRefusedOrWithinTheirLimits) {
  constexpr std::size_t bodies = 6;
  std::mt19937_64 random(7);
  const PoseParents chain{std::nullopt, 0, 1, 2, 3, 4};
  for (int run = 0; run < 3000; ++run) {
    PoseEncoder encoder(bodies, GetParam(), chain);
    PoseDecoder decoder(bodies, chain);
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
TEST(PlainPoses, HaveTheseBytes) {
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

TEST(PlainPoses, WholeFrameListsEveryBody) {
  PoseEncoder encoder(3);
  const std::string frame(encoder.encode(0, std::vector<BodyPose>(3)));
  PoseDecoder more(4), fewer(2);
  EXPECT_FALSE(more.take(frame));
  EXPECT_FALSE(fewer.take(frame));
  EXPECT_LE(frame.size(), PoseEncoder::longest_frame(3));
}

}  // namespace
}  // namespace tessera::testing
