// Transforms as messages, as values of buffers, and those that do not come.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "ros2/codec/written_mapping.hpp"
#include "ros2/tf/missing_transform.hpp"
#include "ros2/tf/tf_message.hpp"
#include "ros2/tf/transform_buffer.hpp"
#include "ros2/tf/transform_value.hpp"

namespace tessera::ros2 {
namespace {

using Buffer = TransformBuffer;

constexpr std::int64_t second = 1'000'000'000;

StampedTransform one_edge(const std::string& parent, const std::string& child, std::int64_t ns, double x = 0,
                          const Rotation& rotation = {}) {
  return {{static_cast<std::int32_t>(ns / second), static_cast<std::uint32_t>(ns % second)},
          parent,
          child,
          {{x, 0, 0}, rotation}};
}

TEST(TfMessages, AreReadAsTheyWereWritten) {
  std::vector<StampedTransform> sent{one_edge("map", "odom", 7 * second + 5, 1, Rotation{0, 0, 0.6, 0.8}),
                                     one_edge("odom", "b", second)};
  const auto bytes = tf_message(sent);
  const auto read = read_tf_message(bytes);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ(read->at(0).transform, sent[0].transform);
  EXPECT_EQ(read->at(0).stamp.nanosec, 5U);
  EXPECT_EQ(read->at(1).child, "b");
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(read_tf_message(std::span(bytes).first(size))) << size;
  std::mt19937 random(4);
  for (int number = 0; number < 5'000; ++number) {  // any bytes are read safely
    auto broken = bytes;
    for (int flip = 0; flip < 3; ++flip) broken[random() % broken.size()] = std::byte(random());
    Buffer buffer;
    for (const StampedTransform& one : read_tf_message(broken).value_or(std::vector<StampedTransform>{}))
      static_cast<void>(buffer.take(one, false, 1));
    static_cast<void>(buffer.latest("b", "map"));
  }
}

TEST(TransformValues, AreSentInTheWayTheBufferHasThem) {
  const auto problem = [](const char* fields, const char* type) {
    const auto found = problem_of_sent_transform(written_mapping(fields, "", ""), *parse_value_type(type));
    return found ? found->text : "";
  };
  const std::string unknown =
      "the buffer cannot say that there is no transform, which its safe command has to say";
  EXPECT_EQ(problem("", "{x: float64, y: float64, yaw: float64, known: bool}"), "");
  EXPECT_EQ(problem("", "{x: float64, y: float64, yaw: float64}"), unknown);
  EXPECT_EQ(problem("yaw=theta", "{theta: float64}"), unknown);
  EXPECT_EQ(problem("rotation.z=z", "{z: float64}"), unknown);
  EXPECT_EQ(problem("rotation.z=z, rotation.w=w", "{z: float64, w: float64}"), "");
  EXPECT_EQ(problem("rotation=q", "{q: {x: float64, y: float64, z: float64, w: float64}}"), "");
  EXPECT_EQ(problem("rotation", "{x: float64, y: float64, z: float64, w: float64}"), "");
  EXPECT_EQ(problem("", "{x: float64, translation: {x: float64}, known: bool}"),
            "the buffer has both 'x' and 'translation'");
}

TEST(MissingTransforms, AreNamedOnceForEachReason) {
  using namespace std::chrono_literals;
  Buffer buffer;
  const MissingTransform::Clock::time_point begin{};
  MissingTransform missing("base_link", "map", "", "/tf and /tf_static", begin);
  const auto told = [&](auto after) {
    return missing.look(buffer.latest("base_link", "map"), begin + after, buffer).value_or("");
  };
  EXPECT_EQ(told(2s), "");
  EXPECT_EQ(told(6s),
            "there is no transform of `base_link` in `map`: nothing has come on /tf and /tf_static");
  EXPECT_EQ(told(7s), "");
  buffer.take(one_edge("odom", "base_link", second), false, 1);
  EXPECT_EQ(told(8s),
            "there is no transform of `base_link` in `map`: no frame `map`; known: base_link, odom");
  buffer.take(one_edge("map", "dock", second), false, 1);
  EXPECT_EQ(told(9s),
            "there is no transform of `base_link` in `map`: they are in two trees, whose roots are `odom` "
            "and `map`");
  buffer.take(one_edge("map", "odom", 2 * second), false, 1);
  EXPECT_EQ(
      told(10s),
      "there is no transform of `base_link` in `map`: the frames between them are known at no common time; "
      "`odom` is not known at that of the others");
  buffer.take(one_edge("odom", "base_link", 2 * second), false, 1);
  EXPECT_EQ(told(11s), "the transform of `base_link` in `map` is there");
  EXPECT_EQ(told(12s), "");
  MissingTransform wrong("base_lin", "map", "", "/tf and /tf_static", begin);
  EXPECT_EQ(
      wrong.look(buffer.latest("base_lin", "map"), begin + 9s, buffer).value_or(""),
      "there is no transform of `base_lin` in `map`: no frame `base_lin`; known: base_link, dock, map, odom; "
      "did you mean 'base_link'?");
}

}  // namespace
}  // namespace tessera::ros2
