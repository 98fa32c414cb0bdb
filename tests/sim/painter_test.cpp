// Worlds that are drawn as they were recorded.

#include "sim/painter.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "sim/rendering/offscreen.hpp"
#include "small_worlds.hpp"

namespace tessera::testing {
namespace {

using ::testing::HasSubstr;

/// A red ball on a slide, which carries an invisible arm with a green ball at its end. A camera looks along y.
constexpr const char* stage = R"(<mujoco model="stage">
  <size njmax="400" nconmax="100"/>
  <worldbody>
    <light pos="0 -1 3" castshadow="false"/>
    <geom type="plane" size="5 5 0.1" rgba="0.9 0.9 0.9 1"/>
    <camera name="front" pos="0 -3 0.5" xyaxes="1 0 0 0 0 1" fovy="60"/>
    <body name="ball" pos="0 0 0.5"><joint type="slide" axis="1 0 0"/>
      <geom type="sphere" size="0.25" rgba="1 0 0 1"/>
      <body pos="0 0 0.6"><body><geom type="sphere" size="0.2" rgba="0 1 0 1"/></body></body>
    </body>
  </worldbody>
</mujoco>)";

constexpr int painted_width = 64, painted_height = 48;

/// The middle of the pixels in which one colour is far stronger than the others; -1: there are none.
struct Spot {
  double x = -1, y = -1;
};
[[nodiscard]] Spot spot_of(const std::vector<std::uint8_t>& rgb, std::size_t colour) {
  Spot sum{0, 0};
  int count = 0;
  for (int y = 0; y < painted_height; ++y)
    for (int x = 0; x < painted_width; ++x) {
      const std::uint8_t* const pixel = &rgb[static_cast<std::size_t>(3 * (y * painted_width + x))];
      if (pixel[colour] < 2 * pixel[(colour + 1) % 3] + 20 ||
          pixel[colour] < 2 * pixel[(colour + 2) % 3] + 20)
        continue;
      sum.x += x;
      sum.y += y;
      ++count;
    }
  return count == 0 ? Spot{} : Spot{sum.x / count, sum.y / count};
}

class Painting : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto missing = sim::OffscreenContext::open("libEGL.so.1");
    if (!missing) GTEST_SKIP() << missing.problem();
    world_.world = ::testing::TempDir() + "painted_stage_" + std::to_string(getpid()) + ".xml";
    std::ofstream(world_.world) << stage;
    picture_.width = painted_width;
    picture_.height = painted_height;
    picture_.bodies = {"ball", "body 3"};
    picture_.middle_m = {0, 0, 0.5};
    picture_.radius_m = 1.5;
  }
  [[nodiscard]] std::vector<std::uint8_t> painted(double x_m) const {
    const auto painter = sim::open_painter(world_, picture_);
    if (!painter) throw std::runtime_error(painter.problem());
    std::vector<std::uint8_t> rgb(std::size_t{3} * painted_width * painted_height);
    const std::vector<BodyPose> poses{{{x_m, 0, 0.5}, {1, 0, 0, 0}}, {{x_m, 0, 1.1}, {1, 0, 0, 0}}};
    (*painter)->paint(poses, rgb);
    return rgb;
  }
  WorldOptions world_;
  PictureOptions picture_;
};

TEST_F(Painting, ShowsBodiesWhereTheRecordingSaysFromAnyCamera) {
  for (const char* camera : {"", "front"}) {
    picture_.camera = camera;
    const std::vector<std::uint8_t> left = painted(-0.7), right = painted(0.7);
    for (const std::size_t colour : {0U, 1U}) {
      EXPECT_LT(spot_of(left, colour).x, painted_width / 2.0 - 4) << camera << colour;
      EXPECT_GT(spot_of(right, colour).x, painted_width / 2.0 + 4) << camera << colour;
    }
    EXPECT_LT(spot_of(left, 1).y, spot_of(left, 0).y) << "green is above red";
    EXPECT_EQ(left, painted(-0.7)) << "the same poses give the same pixels";
  }
}

TEST_F(Painting, ShowsTheTrackOnTheFloorTheRightWayRound) {
  // The shipped oval lies in the positive quadrant.
  world_.track = std::string(TESSERA_SOURCE_DIR) + "/share/tessera/tracks/oval.png";
  picture_.middle_m = {1.5, 1, 0};
  picture_.radius_m = 2;
  picture_.elevation_deg = -90;
  const std::vector<std::uint8_t> with = painted(-3);
  world_.track.clear();
  EXPECT_NE(with, painted(-3));
}

TEST_F(Painting, OfAnotherWorldOrCameraIsRefusedWithWhatThereIs) {
  picture_.camera = "frond";
  EXPECT_THAT(sim::open_painter(world_, picture_).problem(), HasSubstr("did you mean 'front'?"));
  picture_.camera.clear();
  picture_.bodies = {"ball", "bat"};
  EXPECT_THAT(sim::open_painter(world_, picture_).problem(),
              HasSubstr("the world has changed since the run"));
  picture_.width = 5000;
  EXPECT_THAT(sim::open_painter(world_, picture_).problem(), HasSubstr("at most 2048 x 2048"));
  world_.world = "/nowhere/world.xml";
  picture_.width = painted_width;
  EXPECT_THAT(sim::open_painter(world_, picture_).problem(), HasSubstr("/nowhere/world.xml"));
}

}  // namespace
}  // namespace tessera::testing
