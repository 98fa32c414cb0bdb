// Cameras see the track where light sensors read it, and the physics does not notice.

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "drawing.hpp"
#include "sim/rendering/offscreen.hpp"
#include "sim/track.hpp"
#include "small_worlds.hpp"
#include "tessera/large_array.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

constexpr double eye_x_m = 1, eye_y_m = 0.7, eye_z_m = 1.5, fovy_deg = 60;

/// A camera looks down at a grey floor from 1.5 m. A ball falls on the edge of a
/// blue box.
constexpr const char* hall_below = R"(<mujoco model="hall">
  <size njmax="400" nconmax="100"/>
  <asset><texture name="blue" type="2d" builtin="flat" rgb1="0 0 1" width="5" height="3"/>
    <material name="blue" texture="blue"/></asset>
  <worldbody>
    <light pos="1 0.7 3" dir="0 0 -1" directional="true" diffuse="0.5 0.5 0.5" castshadow="false"/>
    <geom name="floor" type="plane" size="5 5 0.1" rgba="0.5 0.5 0.5 1"/>
    <geom type="box" size="0.1 0.1 0.1" pos="1 2 0.1" material="blue"/>
    <camera name="down" pos="1 0.7 1.5" fovy="60"/>
    <body name="ball" pos="1.08 1.96 0.35"><freejoint name="ball"/><geom type="sphere" size="0.1"/></body>
  </worldbody>
</mujoco>)";

constexpr int columns = 201, rows = 151;
using FloorPixels = LargeArray<std::uint8_t, 3UL * columns * rows>;
using FloorDistances = LargeArray<float, 1UL * columns * rows>;
using FloorBodies = LargeArray<std::uint16_t, 1UL * columns * rows>;
const std::map<std::string, WorldOption> picture_size{{"width", columns}, {"height", rows}};

std::unique_ptr<World> open_hall(const std::string& track, double metres_per_pixel = 0.013) {
  return open(
      {.world = file_with("hall.xml", hall_below), .track = track, .metres_per_pixel = metres_per_pixel});
}

template <class T>
auto seen_below(World& world, const std::string& kind) {
  const auto device = receptor<T>(world, {"robot.eye.picture", kind, {"down"}, picture_size});
  EXPECT_TRUE(device->open());
  T value;
  EXPECT_TRUE(device->read({reinterpret_cast<std::byte*>(&value), sizeof value}));
  return std::vector(std::as_const(value).begin(), std::as_const(value).end());
}

/// The first of the three numbers of the pixel that shows this point of the floor.
std::size_t pixel_of(const sim::Point& at) {
  const double pixels_per_m = rows / 2.0 / (eye_z_m * std::tan(fovy_deg / 2 * std::numbers::pi / 180));
  const auto column = static_cast<std::size_t>(columns / 2.0 + (at.x_m - eye_x_m) * pixels_per_m);
  const auto row = static_cast<std::size_t>(rows / 2.0 - (at.y_m - eye_y_m) * pixels_per_m);
  return 3 * (row * columns + column);
}

constexpr std::size_t cells_across = 21, cells_up = 15, cell_px = 7;
/// Black and white cells without any symmetry; the number of its columns is odd.
std::string cells_png() {
  std::mt19937 random(5);
  std::vector<bool> dark;
  for (std::size_t cell = 0; cell < cells_across * cells_up; ++cell) dark.push_back(random() % 2 == 0);
  std::vector<std::uint8_t> grey;
  for (std::size_t y = 0; y < cells_up * cell_px; ++y)
    for (std::size_t x = 0; x < cells_across * cell_px; ++x)
      grey.push_back(dark[y / cell_px * cells_across + x / cell_px] ? 0 : 255);
  return write_png(grey, cells_across * cell_px, "cells");
}

/// A picture whose left half has one colour and whose right half another.
std::string halves_png(const std::string& name, std::uint32_t width, std::uint32_t height,
                       std::array<std::uint8_t, 4> left, std::array<std::uint8_t, 4> right) {
  std::vector<std::uint8_t> pixels;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const auto& colour = x < width / 2 ? left : right;
      pixels.insert(pixels.end(), colour.begin(), colour.end());
    }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGBA;
  const std::string path = temporary(name + ".png");
  EXPECT_NE(png_image_write_to_file(&image, path.c_str(), 0, pixels.data(), 0, nullptr), 0);
  return path;
}

class TrackInCameras : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto missing = sim::OffscreenContext::open("libEGL.so.1");
    if (!missing) GTEST_SKIP() << missing.problem();
  }
};

TEST_F(TrackInCameras, IsWhereLightSensorsReadIt) {
  const std::string png = cells_png();
  constexpr double metres_per_pixel = 0.013, cell_m = cell_px * metres_per_pixel;
  const auto track = sim::Track::load(png, metres_per_pixel);
  ASSERT_TRUE(track);
  const auto rgb = seen_below<FloorPixels>(*open_hall(png), "camera");
  std::size_t dark = 0;
  for (std::size_t up = 0; up < cells_up; ++up)
    for (std::size_t across = 0; across < cells_across; ++across)
      for (const double beside : {-0.3, 0.0, 0.3}) {
        const sim::Point at{(static_cast<double>(across) + 0.5 + beside) * cell_m,
                            (static_cast<double>(up) + 0.5 + beside) * cell_m};
        const bool read_dark = track->reflectance(at, 0.008) < 0.5;
        dark += read_dark ? 1 : 0;
        const int grey = rgb[pixel_of(at)];
        EXPECT_TRUE(read_dark ? grey < 60 : grey > 150) << at.x_m << " " << at.y_m << ": " << grey;
      }
  EXPECT_GT(dark, 300U);
  EXPECT_LT(dark, 700U);
}

TEST_F(TrackInCameras, BesideItIsTheFloorOfTheWorld) {
  const std::string png = halves_png("half_hall", 50, 50, {0, 0, 0, 255}, {255, 255, 255, 255});
  const auto with = seen_below<FloorPixels>(*open_hall(png, 0.02), "camera"),
             without = seen_below<FloorPixels>(*open_hall(""), "camera");
  EXPECT_LT(with[pixel_of({0.4, 0.5})], 60);
  EXPECT_GT(with[pixel_of({0.6, 0.5})], without[pixel_of({0.6, 0.5})] + 40);
  for (const sim::Point beside : {sim::Point{1.1, 0.5}, sim::Point{0.5, 1.1}, sim::Point{0.5, -0.05}})
    EXPECT_EQ(with[pixel_of(beside)], without[pixel_of(beside)]);
}

TEST_F(TrackInCameras, HasItsColoursAndWhiteWhereItIsTransparent) {
  const auto rgb = seen_below<FloorPixels>(
      *open_hall(halves_png("coloured", 101, 71, {200, 0, 0, 255}, {0, 0, 0, 0}), 0.02), "camera");
  const std::size_t left = pixel_of({0.5, 0.7}), right = pixel_of({1.5, 0.7});
  EXPECT_GT(rgb[left], 80);
  EXPECT_LT(rgb[left + 1], 20);
  for (const std::size_t colour : {0U, 1U, 2U}) EXPECT_GT(rgb[right + colour], 150);
}

TEST_F(TrackInCameras, OfMorePixelsThanARendererTakesKeepsPlaceAndScale) {
  const std::string png = halves_png("large", 5001, 500, {0, 0, 0, 255}, {255, 255, 255, 255});
  const auto rgb = seen_below<FloorPixels>(*open_hall(png, 0.0004), "camera");
  const auto without = seen_below<FloorPixels>(*open_hall(""), "camera");
  EXPECT_LT(rgb[pixel_of({0.97, 0.1})], 60);
  for (const sim::Point right : {sim::Point{1.03, 0.1}, sim::Point{1.95, 0.02}, sim::Point{1.95, 0.18}})
    EXPECT_GT(rgb[pixel_of(right)], without[pixel_of(right)] + 40);
  for (const sim::Point beside : {sim::Point{2.05, 0.1}, sim::Point{1.95, 0.25}, sim::Point{1, -0.05}})
    EXPECT_EQ(rgb[pixel_of(beside)], without[pixel_of(beside)]);
}

TEST_F(TrackInCameras, ChangesNeitherDepthsNorLabels) {
  const std::string png = cells_png();
  EXPECT_EQ(seen_below<FloorDistances>(*open_hall(png), "depth"),
            seen_below<FloorDistances>(*open_hall(""), "depth"));
  EXPECT_EQ(seen_below<FloorBodies>(*open_hall(png), "labels"),
            seen_below<FloorBodies>(*open_hall(""), "labels"));
}

/// The bits of the ball's pose after each of a hundred steps.
std::vector<std::uint64_t> ball_poses(const std::string& track, bool filmed) {
  const auto world = open_hall(track);
  const auto camera = receptor<FloorPixels>(*world, {"a.eye.p", "camera", {"down"}, picture_size});
  const auto ball = receptor<std::array<double, 7>>(*world, {"a.s.b", "joint_position", {"ball"}, {}});
  FloorPixels picture;
  std::vector<std::uint64_t> bits;
  for (int step = 0; step < 100; ++step) {
    world->advance_to(Time(step * 10ms));
    if (filmed) {
      EXPECT_TRUE(camera->read({reinterpret_cast<std::byte*>(&picture), sizeof picture}));
    }
    for (const double number : read_as<std::array<double, 7>>(*ball))
      bits.push_back(std::bit_cast<std::uint64_t>(number));
  }
  return bits;
}

TEST_F(TrackInCameras, DoesNotDisturbThePhysics) {
  const std::string png = cells_png();
  const auto filmed = ball_poses(png, true);
  EXPECT_EQ(filmed, ball_poses(png, false));
  EXPECT_EQ(filmed, ball_poses("", true));
  EXPECT_EQ(filmed, ball_poses("", false));
}

}  // namespace
}  // namespace tessera::testing
