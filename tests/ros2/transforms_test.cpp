// The tree of transforms. The judge of its numbers are matrices, and Rodrigues' formula between two of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "ros2/tf/tf_message.hpp"
#include "ros2/tf/transform.hpp"
#include "ros2/tf/transform_buffer.hpp"

namespace tessera::ros2 {
namespace {

using Buffer = TransformBuffer;
using Outcome = Buffer::Answer::Outcome;
using Oddity = Buffer::Oddity;
using Refusal = Buffer::Refusal;

constexpr std::int64_t s = 1'000'000'000;

StampedTransform edge(const std::string& parent, const std::string& child, std::int64_t ns, double x = 0,
                      const Rotation& rotation = {}) {
  return {{static_cast<std::int32_t>(ns / s), static_cast<std::uint32_t>(ns % s)},
          parent,
          child,
          {{x, 0, 0}, rotation}};
}
Rotation about_z(double angle) { return {0, 0, std::sin(angle / 2), std::cos(angle / 2)}; }

/// A rigid motion as a matrix of four rows.
using Matrix = std::array<std::array<double, 4>, 4>;
Matrix matrix_of(const Transform& one) {
  const auto& [x, y, z, w] = one.rotation;
  const auto& p = one.translation;
  return {{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y), p.x},
           {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x), p.y},
           {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z, p.z},
           {0, 0, 0, 1}}};
}
Matrix product(const Matrix& a, const Matrix& b) {
  Matrix all{};
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      for (std::size_t k = 0; k < 4; ++k) all[row][column] += a[row][k] * b[k][column];
  return all;
}
Matrix inverse_of(const Matrix& a) {
  Matrix all{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) {
      all[row][column] = a[column][row];
      all[row][3] -= a[column][row] * a[column][3];
    }
  all[3][3] = 1;
  return all;
}
double distance(const Matrix& a, const Matrix& b) {
  double most = 0;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      most = std::max(most, std::abs(a[row][column] - b[row][column]));
  return most;
}

/// From one motion to another: the translation on a line, the rotation about one axis.
Matrix between(const Matrix& a, const Matrix& b, double share) {
  Matrix ra = a, rb = b;
  for (std::size_t row = 0; row < 3; ++row) ra[row][3] = rb[row][3] = 0;
  const Matrix turn = product(inverse_of(ra), rb);
  const double angle = std::acos(std::clamp((turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2, -1.0, 1.0));
  const double scale = angle < 1e-9 ? 0 : 1 / (2 * std::sin(angle));
  const std::array<double, 3> n{(turn[2][1] - turn[1][2]) * scale, (turn[0][2] - turn[2][0]) * scale,
                                (turn[1][0] - turn[0][1]) * scale};
  const Matrix cross{{{0, -n[2], n[1], 0}, {n[2], 0, -n[0], 0}, {-n[1], n[0], 0, 0}, {0, 0, 0, 0}}};
  const Matrix square = product(cross, cross);
  Matrix part{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column)
      part[row][column] =
          std::sin(share * angle) * cross[row][column] + (1 - std::cos(share * angle)) * square[row][column];
    part[row][row] += 1;
  }
  Matrix all = product(ra, part);
  for (std::size_t row = 0; row < 3; ++row) all[row][3] = (1 - share) * a[row][3] + share * b[row][3];
  return all;
}

Transform random_transform(std::mt19937& random) {
  std::normal_distribution<double> any;
  const auto number = [&] { return any(random); };
  return {{number(), number(), number()}, normalized({number(), number(), number(), number()})};
}

TEST(Transforms, ComposeAsMatricesDoAndTurnRound) {
  std::mt19937 random(1);
  for (int number = 0; number < 1000; ++number) {
    const Transform a = random_transform(random), b = random_transform(random);
    EXPECT_LT(distance(matrix_of(a * b), product(matrix_of(a), matrix_of(b))), 1e-12);
    EXPECT_LT(distance(matrix_of(inverse(a)), inverse_of(matrix_of(a))), 1e-12);
  }
}

TEST(Transforms, BetweenTwoStampsGoTheShorterWay) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> shares(0, 1);
  for (int number = 0; number < 1000; ++number) {
    const Transform a = random_transform(random), b = random_transform(random);
    const double share = shares(random);
    EXPECT_LT(distance(matrix_of(interpolated(a, b, share)), between(matrix_of(a), matrix_of(b), share)),
              1e-7);
  }
  const Rotation half = interpolated({{}, about_z(3.0)}, {{}, about_z(-3.0)}, 0.5).rotation;
  EXPECT_NEAR(std::abs(angles_of(half).yaw), std::numbers::pi, 1e-12);
}

TEST(Transforms, HaveAnglesThatGiveTheSameRotation) {
  std::mt19937 random(3);
  for (int number = 0; number < 1000; ++number) {
    const Rotation one = random_transform(random).rotation;
    EXPECT_LT(distance(matrix_of({{}, one}), matrix_of({{}, rotation_of(angles_of(one))})), 1e-9);
  }
  for (const double pitch : {-std::numbers::pi / 2, std::numbers::pi / 2}) {
    const Rotation one = rotation_of({0.3, pitch, -1.1});
    EXPECT_LT(distance(matrix_of({{}, one}), matrix_of({{}, rotation_of(angles_of(one))})), 1e-6);
  }
  const RollPitchYaw angles = angles_of(rotation_of({0.1, -0.2, 3.0}));
  EXPECT_NEAR(angles.roll, 0.1, 1e-12);
  EXPECT_NEAR(angles.pitch, -0.2, 1e-12);
  EXPECT_NEAR(angles.yaw, 3.0, 1e-12);
}

/// A random tree of fixed and moving frames, each with a pose in its parent at every whole second.
struct RandomTree {
  static constexpr std::size_t frames = 12, stamps = 8;
  explicit RandomTree(std::uint32_t seed) : random(seed) {
    for (std::size_t child = 1; child < frames; ++child) {
      parent[child] = std::uniform_int_distribution<std::size_t>(0, child - 1)(random);
      fixed[child] = random() % 3 == 0;
      for (std::size_t stamp = 0; stamp < stamps; ++stamp) {
        if (fixed[child] && stamp > 0) {
          poses[child].push_back(poses[child][0]);
          continue;
        }
        poses[child].push_back(random_transform(random));
        StampedTransform one = edge(name(parent[child]), name(child), static_cast<std::int64_t>(stamp) * s);
        one.transform = poses[child].back();
        EXPECT_EQ(buffer.take(one, fixed[child], 1).refusal, Refusal::none);
      }
    }
  }
  static std::string name(std::size_t frame) { return "f" + std::to_string(frame); }
  /// The pose of a frame in the root at a time in seconds.
  [[nodiscard]] Matrix in_root(std::size_t frame, double time) const {
    Matrix all = matrix_of({});
    for (; frame != 0; frame = parent[frame]) {
      const auto first = static_cast<std::size_t>(time);
      const Matrix a = matrix_of(poses[frame][first]);
      const double share = time - std::floor(time);
      all = product(share == 0 ? a : between(a, matrix_of(poses[frame][first + 1]), share), all);
    }
    return all;
  }
  std::mt19937 random;
  Buffer buffer;
  std::array<std::size_t, frames> parent{};
  std::array<bool, frames> fixed{};
  std::array<std::vector<Transform>, frames> poses;
};

TEST(TransformTrees, GiveEveryFrameInEveryOtherAtAnyTime) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    RandomTree tree(seed);
    for (int number = 0; number < 100; ++number) {
      const std::size_t from = tree.random() % RandomTree::frames, to = tree.random() % RandomTree::frames;
      if (from == to) continue;
      const std::int64_t ms = tree.random() % ((RandomTree::stamps - 1) * 1000);
      const auto answer = tree.buffer.at(RandomTree::name(from), RandomTree::name(to), ms * (s / 1000));
      ASSERT_EQ(answer.outcome, Outcome::found);
      const double time = static_cast<double>(ms) / 1000;
      EXPECT_LT(distance(matrix_of(answer.transform),
                         product(inverse_of(tree.in_root(to, time)), tree.in_root(from, time))),
                1e-6);
    }
  }
}

TEST(TransformTrees, GiveTheNewestTimeThatAllFramesBetweenHave) {
  Buffer buffer;
  for (int second = 1; second <= 5; ++second) {
    EXPECT_EQ(buffer.take(edge("odom", "base", second * s, second), false, 1).oddity, Oddity::none);
    if (second <= 3) {
      EXPECT_EQ(buffer.take(edge("map", "odom", second * s, 10), false, 2).oddity, Oddity::none);
    }
  }
  EXPECT_EQ(buffer.take(edge("base", "laser", 0, 0.5), true, 3).oddity, Oddity::none);
  const auto in_map = buffer.latest("laser", "map");
  EXPECT_EQ(in_map.outcome, Outcome::found);
  EXPECT_EQ(in_map.stamp_ns, 3 * s);
  EXPECT_EQ(in_map.transform.translation.x, 13.5);
  EXPECT_EQ(buffer.latest("laser", "odom").stamp_ns, 5 * s);
  EXPECT_EQ(buffer.latest("odom", "base").transform.translation.x, -5);
  EXPECT_TRUE(buffer.latest("laser", "base").fixed);
  EXPECT_FALSE(in_map.fixed);
}

TEST(TransformTrees, AreNeverExtrapolated) {
  Buffer buffer;
  buffer.take(edge("odom", "base", 2 * s, 2), false, 1);
  EXPECT_EQ(buffer.at("base", "odom", 2 * s).outcome, Outcome::found);
  EXPECT_EQ(buffer.at("base", "odom", 2 * s + 1).outcome, Outcome::no_common_time);
  buffer.take(edge("odom", "base", 4 * s, 4), false, 1);
  EXPECT_EQ(buffer.at("base", "odom", 3 * s).transform.translation.x, 3);
  EXPECT_EQ(buffer.at("base", "odom", 2 * s - 1).outcome, Outcome::no_common_time);
  EXPECT_EQ(buffer.at("base", "odom", 4 * s + 1).outcome, Outcome::no_common_time);
  // A frame that is only known later than the other one.
  buffer.take(edge("base", "arm", 5 * s), false, 2);
  EXPECT_EQ(buffer.latest("arm", "odom").outcome, Outcome::no_common_time);
  // A stranger above them does not matter.
  buffer.take(edge("map", "odom", s), false, 3);
  EXPECT_EQ(buffer.at("base", "odom", 3 * s).outcome, Outcome::found);
}

TEST(TransformTrees, KeepTenSeconds) {
  Buffer buffer;
  for (int second = 0; second <= 15; ++second) buffer.take(edge("odom", "base", second * s), false, 1);
  EXPECT_EQ(buffer.at("base", "odom", 5 * s).outcome, Outcome::found);
  EXPECT_EQ(buffer.at("base", "odom", 5 * s - 1).outcome, Outcome::no_common_time);
}

TEST(TransformTrees, TakeMessagesThatComeInAnotherOrder) {
  Buffer buffer;
  for (const int tenth : {5, 3, 4, 1}) buffer.take(edge("odom", "base", tenth * s / 10, tenth), false, 1);
  EXPECT_EQ(buffer.latest("base", "odom").transform.translation.x, 5);
  EXPECT_EQ(buffer.at("base", "odom", s / 5).transform.translation.x, 2);
  buffer.take(edge("odom", "base", s / 2, 7), false, 1);  // the same stamp again
  EXPECT_EQ(buffer.latest("base", "odom").transform.translation.x, 7);
}

TEST(TransformTrees, ForgetAllThatMovesWhenTimeGoesBack) {
  Buffer buffer;
  buffer.take(edge("base", "laser", 0), true, 3);
  buffer.take(edge("map", "odom", 8 * s), false, 2);
  for (int second = 5; second <= 8; ++second) buffer.take(edge("odom", "base", second * s), false, 1);
  std::vector<Buffer::Taken> taken;
  for (int tenth = 1; tenth <= 5; ++tenth)
    taken.push_back(buffer.take(edge("odom", "base", tenth * s / 10), false, 1));
  EXPECT_EQ(buffer.jumps(), 1U);
  EXPECT_EQ(taken[2].oddity, Oddity::went_back);
  EXPECT_EQ(taken[2].back_ns, 8 * s - 3 * s / 10);
  EXPECT_EQ(buffer.latest("laser", "odom").stamp_ns, s / 2);
  EXPECT_EQ(buffer.latest("laser", "map").outcome, Outcome::unconnected);
  EXPECT_EQ(buffer.at("base", "odom", s / 10).outcome, Outcome::no_common_time);
  // More than the buffer holds: at once. A clock that is ahead for one message does no harm.
  EXPECT_EQ(buffer.take(edge("odom", "base", 1'000'000 * s), false, 1).oddity, Oddity::none);
  EXPECT_EQ(buffer.take(edge("odom", "base", 2 * s), false, 1).oddity, Oddity::went_back);
  // Clocks of two machines that differ by less than a second are no jump.
  for (int number = 0; number < 9; ++number) buffer.take(edge("odom", "base", s + s / 2), false, 1);
  EXPECT_EQ(buffer.jumps(), 2U);
}

TEST(TransformTrees, NameParentsAndPublishersThatTakeTurns) {
  Buffer buffer;
  int parents = 0, publishers = 0;
  for (int tenth = 0; tenth < 40; ++tenth) {
    const auto taken = buffer.take(edge(tenth % 2 == 0 ? "odom" : "map", "base", tenth * s / 10), false, 1);
    if (taken.oddity != Oddity::two_parents) continue;
    ++parents;
    EXPECT_EQ(taken.other, tenth % 2 == 0 ? "map" : "odom");
    publishers += buffer.take(edge("odom", "arm", tenth * s / 10), false, 1).oddity != Oddity::none;
  }
  EXPECT_GT(parents, 3);
  EXPECT_EQ(publishers, 0);
  for (int tenth = 0; tenth < 40; ++tenth)
    publishers += buffer.take(edge("base", "camera", tenth * s / 10), false, tenth % 2 + 5U).oddity ==
                  Oddity::two_publishers;
  EXPECT_GT(publishers, 3);
  // Another parent or publisher, once, is none: something was taken up, and a program started again.
  EXPECT_EQ(buffer.take(edge("world", "box", s), false, 1).oddity, Oddity::none);
  EXPECT_EQ(buffer.take(edge("gripper", "box", 2 * s), false, 2).oddity, Oddity::none);
  EXPECT_EQ(buffer.latest("box", "gripper").outcome, Outcome::found);
  // At all times a frame has one parent only.
  buffer.take(edge("base", "laser", 0), true, 1);
  EXPECT_EQ(buffer.take(edge("base", "laser", 5 * s), true, 2).oddity, Oddity::none);
  EXPECT_EQ(buffer.take(edge("odom", "laser", 0), true, 2).oddity, Oddity::two_parents);
  EXPECT_EQ(buffer.take(edge("odom", "laser", 0), false, 2).oddity, Oddity::moves_and_not);
}

TEST(TransformTrees, NameLoopsStrangersAndTwoTrees) {
  Buffer buffer;
  EXPECT_EQ(buffer.latest("base", "map").outcome, Outcome::unknown_frame);
  buffer.take(edge("odom", "base", s), false, 1);
  const auto unknown = buffer.latest("base", "map");
  EXPECT_EQ(unknown.outcome, Outcome::unknown_frame);
  EXPECT_EQ(unknown.frames, std::vector<std::string>{"map"});
  buffer.take(edge("map", "station", s), false, 1);
  const auto trees = buffer.latest("base", "station");
  EXPECT_EQ(trees.outcome, Outcome::unconnected);
  EXPECT_EQ(trees.frames, (std::vector<std::string>{"odom", "map"}));
  buffer.take(edge("base", "odom", s), false, 1);
  const auto loop = buffer.latest("base", "map");
  EXPECT_EQ(loop.outcome, Outcome::loop);
  EXPECT_EQ(loop.frames, (std::vector<std::string>{"base", "odom"}));
}

TEST(TransformTrees, RefuseWhatIsNoTransform) {
  Buffer buffer;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [&](StampedTransform one) { return buffer.take(one, false, 1).refusal; };
  EXPECT_EQ(refusal(edge("", "base", s)), Refusal::no_name);
  EXPECT_EQ(refusal(edge("map", "/", s)), Refusal::no_name);
  EXPECT_EQ(refusal(edge("/base", "base", s)), Refusal::own_parent);
  EXPECT_EQ(refusal(edge("map", "base", s, nan)), Refusal::not_finite);
  EXPECT_EQ(refusal(edge("map", "base", s, 0, {0, 0, 0, 0})), Refusal::not_unit);
  EXPECT_EQ(refusal(edge("map", "base", s, 0, {0, 0, 0.2, 1})), Refusal::not_unit);
  StampedTransform late = edge("map", "base", s);
  late.stamp.nanosec = 1'000'000'000;
  EXPECT_EQ(refusal(late), Refusal::bad_stamp);
  late.stamp = {-1, 0};
  EXPECT_EQ(refusal(late), Refusal::bad_stamp);
  EXPECT_TRUE(buffer.frames().empty());
  EXPECT_EQ(refusal(edge("/map", "/base", s, 1, {0, 0, 0, 1.001})), Refusal::none);
  EXPECT_EQ(buffer.latest("base", "map").transform, (Transform{{1, 0, 0}, {}}));
}

}  // namespace
}  // namespace tessera::ros2
