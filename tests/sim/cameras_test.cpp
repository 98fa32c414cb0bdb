// Cameras of simulated worlds: their pictures are the same from run to run, and do not disturb the physics.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "sim/rendering/offscreen.hpp"
#include "small_worlds.hpp"
#include "tessera/large_array.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// A camera looks along the y axis at a red box, whose face is 1 m away, and at a wall 3 m away. A site is
/// in front of it, and a range finder. A blue ball falls beside the box.
constexpr const char* studio = R"(<mujoco model="studio">
  <size njmax="400" nconmax="100"/>
  <asset><texture type="skybox" builtin="gradient" rgb1="0.4 0.6 0.8" rgb2="0 0 0" width="32" height="32"/></asset>
  <worldbody>
    <light pos="0 0 3"/>
    <geom name="floor" type="plane" size="5 5 0.1" pos="0 0 -1" rgba="0.8 0.8 0.8 1"/>
    <camera name="front" pos="0 0 0.5" xyaxes="1 0 0 0 0 1" fovy="60"/>
    <camera name="back" pos="0 0 0.5" xyaxes="-1 0 0 0 0 1" fovy="60"/>
    <site name="eye" pos="0 0.5 0.5" euler="-90 0 0" size="0.2" rgba="0 1 0 1"/>
    <body name="box" pos="0 1.2 0.5"><geom name="crate" type="box" size="0.2 0.2 0.2" rgba="1 0 0 1"/></body>
    <body name="wall" pos="0 3.1 0"><geom type="box" size="4 0.1 3" rgba="1 1 1 1"/></body>
    <body name="ball" pos="0.6 1.2 1.2"><freejoint name="ball"/>
      <geom name="ball" type="sphere" size="0.1" rgba="0 0 1 1"/></body>
  </worldbody>
  <sensor><rangefinder name="beam" site="eye"/></sensor>
</mujoco>)";

constexpr int width = 63, height = 47;  // odd sizes, to find errors of alignment
constexpr std::size_t middle = std::size_t{height / 2} * width + width / 2;
using Colours = LargeArray<std::uint8_t, 3UL * width * height>;
using Depths = LargeArray<float, 1UL * width * height>;
using Labels = LargeArray<std::uint16_t, 1UL * width * height>;
using Options = std::map<std::string, WorldOption>;
const Options small{{"width", width}, {"height", height}};

/// These tests need libEGL and a renderer, which a machine may lack.
class Cameras : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto missing = sim::OffscreenContext::open("libEGL.so.1");
    if (!missing) GTEST_SKIP() << missing.problem();
  }
};

/// The present picture of the camera, as a value of the type T.
template <class T>
auto look(World& world, const std::string& kind, const std::string& name = "front", Options options = small) {
  const auto device = receptor<T>(world, {"robot.eye.picture", kind, {name}, std::move(options)});
  EXPECT_TRUE(device->open());
  T value;
  EXPECT_TRUE(device->read({reinterpret_cast<std::byte*>(&value), sizeof value}));
  return std::vector(std::as_const(value).begin(), std::as_const(value).end());
}

TEST_F(Cameras, ARedBoxIsRedInTheMiddleAndTheSkyIsUp) {
  const auto world = open_text("red", studio);
  const auto rgb = look<Colours>(*world, "camera");
  EXPECT_GT(rgb[3 * middle], 60) << "red";
  EXPECT_LT(rgb[3 * middle + 1], rgb[3 * middle] / 2) << "a green site is in front of the camera";
  EXPECT_LT(rgb[3 * middle + 2], rgb[3 * middle] / 2);
  const auto out = look<Colours>(*world, "camera", "back");
  const std::size_t top = 3 * (width / 2), bottom = 3 * ((height - 1) * width + width / 2);
  EXPECT_GT(out[top + 2], out[top]) << "the sky is blue";
  EXPECT_NEAR(out[bottom], out[bottom + 2], 8) << "the floor is grey";
}

TEST_F(Cameras, DepthsAreMetresAlongTheViewAndRowsBeginAtTheTop) {
  const auto world = open_text("depth", studio);
  const auto metres = look<Depths>(*world, "depth");
  EXPECT_NEAR(metres[middle], 1, 0.01);
  EXPECT_NEAR(metres[0], 3, 0.03) << "the wall, in the corner too";
  EXPECT_NEAR(metres[width - 1], 3, 0.03);
  EXPECT_LT(metres[Depths::size() - 1], 2.9) << "the floor";
  EXPECT_GT(look<Depths>(*world, "depth", "back")[0], 20) << "nothing up there";
}

TEST_F(Cameras, LabelsAreTheNumbersOfTheBodies) {
  const auto world = open_text("labels", studio);
  world->advance_to(Time(200ms));
  const auto bodies = look<Labels>(*world, "labels");
  EXPECT_EQ(bodies[middle], 1);
  EXPECT_EQ(bodies[0], 2);
  EXPECT_EQ(bodies[Labels::size() - 1], 0) << "the floor belongs to the world";
  std::vector<std::uint16_t> seen(bodies);
  std::ranges::sort(seen);
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  EXPECT_EQ(seen, (std::vector<std::uint16_t>{0, 1, 2, 3}));
}

TEST_F(Cameras, NoiseOfDepthsComesFromTheSeed) {
  Options noisy = small;
  noisy["noise"] = WorldValue(0.1, "m");
  const auto depths = [&](std::uint64_t seed) {
    return look<Depths>(*open_text("noise", studio, seed), "depth", "front", noisy);
  };
  EXPECT_EQ(depths(1), depths(1));
  EXPECT_NE(depths(1), depths(2));
  EXPECT_EQ(std::ranges::count(depths(1), look<Depths>(*open_text("sky", studio), "depth")[0]), 0);
}

/// All pictures of a run of the falling ball, or none; and the bits of its state at the end.
struct Film {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint64_t> state;
};
Film filmed_run(bool filmed, bool other_size_between = false) {
  const auto world = open_text("film", studio);
  const auto device = receptor<Colours>(*world, {"a.eye.p", "camera", {"front"}, small});
  const auto ball = receptor<std::array<double, 7>>(*world, {"a.s.b", "joint_position", {"ball"}, {}});
  Colours picture;
  Film result;
  for (int frame = 0; frame < 20; ++frame) {
    world->advance_to(Time(frame * 50ms));
    if (!filmed) continue;
    EXPECT_TRUE(device->read({reinterpret_cast<std::byte*>(&picture), sizeof picture}));
    result.bytes.insert(result.bytes.end(), std::as_const(picture).begin(), std::as_const(picture).end());
    if (other_size_between && frame == 5) {
      using Large = LargeArray<std::uint8_t, 3UL * 160 * 120>;
      static_cast<void>(look<Large>(*world, "camera", "back", {{"width", 160}, {"height", 120}}));
    }
  }
  for (const double number : read_as<std::array<double, 7>>(*ball))
    result.state.push_back(std::bit_cast<std::uint64_t>(number));
  return result;
}

TEST_F(Cameras, GiveTheSameBytesInEveryRunAndDoNotDisturbThePhysics) {
  const Film first = filmed_run(true);
  EXPECT_EQ(first.bytes, filmed_run(true).bytes);
  EXPECT_EQ(first.bytes, filmed_run(true, true).bytes) << "whatever else is looked at";
  EXPECT_EQ(first.state, filmed_run(false).state);
  const auto half = static_cast<std::ptrdiff_t>(first.bytes.size() / 2);
  EXPECT_FALSE(std::equal(first.bytes.begin(), first.bytes.begin() + half, first.bytes.begin() + half));
}

TEST_F(Cameras, SeeTheColourOfALamp) {
  const auto world = open_text("lamp", studio);
  const auto lamp = effector<std::array<float, 4>>(*world, {"a.l.c", "colour", {"crate"}, {}});
  EXPECT_TRUE(write_as(*lamp, std::array<float, 4>{0, 1, 0, 1}));
  world->advance_to(Time(10ms));
  const auto rgb = look<Colours>(*world, "camera");
  EXPECT_LT(rgb[3 * middle], rgb[3 * middle + 1] / 2);
}

TEST_F(Cameras, SeeTendonsAndSkipHiddenGroups) {
  const auto world = open_text("tendon", R"(<mujoco><worldbody>
      <camera name="front" pos="0 0 0" xyaxes="1 0 0 0 0 1"/>
      <geom type="box" size="2 0.1 2" pos="0 1 0" group="3"/>
      <site name="from" pos="-1 2 0"/><site name="to" pos="1 2 0"/>
    </worldbody><tendon><spatial width="0.2"><site site="from"/><site site="to"/></spatial></tendon></mujoco>)");
  EXPECT_NEAR(look<Depths>(*world, "depth")[middle], 1.8, 0.02);
}

TEST_F(Cameras, SeveralAreReadFromSeveralThreads) {
  const auto world = open_text("threads", studio), other = open_text("other", studio);
  const auto front = look<Depths>(*world, "depth"), back = look<Depths>(*world, "depth", "back");
  const auto reader = [](World& seen, const std::string& name, const std::vector<float>& expected) {
    return std::jthread([&seen, &expected, name] {
      for (int i = 0; i < 20; ++i) EXPECT_EQ(look<Depths>(seen, "depth", name), expected);
    });
  };
  const auto one = reader(*world, "front", front), two = reader(*world, "back", back),
             three = reader(*other, "front", front);
}

TEST_F(Cameras, ManyWorldsShareOneContext) {
  for (int schedule = 0; schedule < 50; ++schedule)
    EXPECT_NEAR(look<Depths>(*open_text("many", studio), "depth")[middle], 1, 0.01);
}

template <class T>
std::string refusal(World& world, const std::string& kind, const std::string& name, Options options) {
  const auto problem = world.problem_with(request_for<T>({"a.s.p", kind, {name}, std::move(options)}), false);
  return problem ? problem->text + " | " + problem->hint + " | " + problem->subject : "";
}

TEST(RefusedCameras, SayWhichBufferWouldFit) {
  const auto world = open_text("refused_cameras", studio);
  using Small = LargeArray<std::uint8_t, 9216>;
  const Options vga{{"width", 640}, {"height", 480}};
  EXPECT_EQ(refusal<Small>(*world, "camera", "front", {{"width", 64}, {"height", 48}}), "");
  EXPECT_EQ(refusal<Small>(*world, "camera", "front", vga),
            "uint8[921600] is 640 x 480 in colour, and the buffer is uint8[9216] | make the buffer "
            "uint8[921600]; uint8[9216] is 64 x 48 in colour | ");
  EXPECT_EQ(
      refusal<Small>(*world, "camera", "front", {}),
      "'camera' needs the options width and height | uint8[9216] is 64 x 48 in colour: write width: 64, "
      "height: 48 | ");
  EXPECT_EQ(refusal<Small>(*world, "camera", "font", {{"width", 64}, {"height", 48}}),
            "the world has no camera 'font' | did you mean 'front'? the world has: front, back | font");
  EXPECT_EQ(
      refusal<Depths>(*world, "camera", "front", small),
      "uint8[8883] is 63 x 47 in colour, and the buffer is float32[2961] | make the buffer uint8[8883] | ");
  EXPECT_EQ(
      refusal<Colours>(*world, "labels", "front", small),
      "uint16[2961] is 63 x 47 in labels, and the buffer is uint8[8883] | make the buffer uint16[2961] | ");
  EXPECT_EQ(refusal<std::uint8_t>(*world, "camera", "front", {{"width", 5000}, {"height", 1}}),
            "option 'width' must be a whole number from 1 to 4096 |  | width");
  EXPECT_EQ(refusal<std::uint8_t>(*world, "camera", "front", {{"width", 0.5}, {"height", 1}}),
            "option 'width' must be a whole number from 1 to 4096 |  | width");
  Options noisy = small;
  noisy["noise"] = 0.1;
  EXPECT_EQ(refusal<Colours>(*world, "camera", "front", noisy),
            "'camera' has no option 'noise' | its options: width, height | noise");
}

TEST(RefusedCameras, WithAnAngleThatNoPictureHas) {
  for (const char* angle : {"0", "180", "500", "-45"}) {
    const auto world = open_text("angle", std::string("<mujoco><worldbody><camera name='c' fovy='") + angle +
                                              "'/></worldbody></mujoco>");
    EXPECT_THAT(refusal<Colours>(*world, "camera", "c", small),
                ::testing::HasSubstr("camera 'c' has an angle of view"))
        << angle;
  }
}

TEST(RefusedCameras, AMachineWithoutEglIsToldWhichPackagesItNeeds) {
  const auto context = sim::OffscreenContext::open("libNoEGL.so.1");
  ASSERT_FALSE(context);
  EXPECT_TRUE(context.problem().ends_with("install the packages libegl1 and libgl1-mesa-dri"))
      << context.problem();
  EXPECT_FALSE(sim::OffscreenContext::open("libc.so.6")) << "which is no EGL";
}

}  // namespace
}  // namespace tessera::testing
