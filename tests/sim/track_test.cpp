#include "sim/track.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "drawing.hpp"
#include "world_library.hpp"

using tessera::sim::Point;
using tessera::sim::Track;

namespace {

Track load(const std::string& png, double metres_per_pixel) {
  auto track = Track::load(png, metres_per_pixel);
  if (!track) throw std::runtime_error(track.problem());
  return *track;
}

/// Left half black, right half white; 20 x 10 pixels.
Track half_black(double metres_per_pixel) {
  std::vector<std::uint8_t> grey;
  for (int i = 0; i < 200; ++i) grey.push_back(i % 20 < 10 ? 0 : 255);
  const std::string png = write_png(grey, 20, "half");
  Track track = load(png, metres_per_pixel);
  std::filesystem::remove(png);
  return track;
}

/// The mean over points spread evenly in the disc: slow, and plainly right.
double brute_force(const Track& track, Point at, double footprint_m) {
  double sum = 0;
  int count = 0;
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double dx = ((i + 0.5) / steps - 0.5) * footprint_m;
      const double dy = ((j + 0.5) / steps - 0.5) * footprint_m;
      if (std::hypot(dx, dy) > footprint_m / 2) continue;
      const auto x = static_cast<std::int64_t>(std::floor((at.x_m + dx) / track.metres_per_pixel()));
      const auto y = track.height_px() - 1 -
                     static_cast<std::int64_t>(std::floor((at.y_m + dy) / track.metres_per_pixel()));
      const bool inside = x >= 0 && y >= 0 && x < track.width_px() && y < track.height_px();
      sum += inside ? track.pixels()[static_cast<std::size_t>(y * track.width_px() + x)] : 255;
      ++count;
    }
  }
  return sum / count / 255;
}

TEST(Track, SizeIsPixelsTimesScale) {
  const Track track = half_black(0.01);
  EXPECT_DOUBLE_EQ(track.width_m(), 0.2);
  EXPECT_DOUBLE_EQ(track.height_m(), 0.1);
}

TEST(Track, ReflectanceIsTheAreaOfTheDiscThatIsBright) {
  const Track track = half_black(0.01);
  constexpr double radius = 0.03;
  for (const double offset : {-0.04, -0.02, -0.01, 0.0, 0.005, 0.025}) {
    const double c = std::min(1.0, std::max(-1.0, offset / radius));
    const double bright = 1 - (std::acos(c) - c * std::sqrt(1 - c * c)) / M_PI;
    EXPECT_NEAR(track.reflectance({0.1 + offset, 0.05}, 2 * radius), bright, 0.004) << offset;
  }
}

TEST(Track, ReflectanceAgreesWithCountingPointsInTheDisc) {
  std::mt19937 random(7);
  std::vector<std::uint8_t> grey(30 * 20);
  for (auto& pixel : grey) pixel = static_cast<std::uint8_t>(random() % 256);
  const std::string png = write_png(grey, 30, "random");
  const Track track = load(png, 0.005);
  std::filesystem::remove(png);
  std::uniform_real_distribution<double> uniform(-0.02, 0.17);
  for (int i = 0; i < 40; ++i) {
    const Point at{uniform(random), uniform(random)};
    const double footprint = 0.002 + 0.02 * (i % 5);
    EXPECT_NEAR(track.reflectance(at, footprint), brute_force(track, at, footprint), 0.01)
        << at.x_m << " " << at.y_m << " " << footprint;
  }
}

TEST(Track, OutsideIsWhite) {
  const Track track = half_black(0.01);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Point at : {Point{-1, 0.05}, {0.05, 5}, {1e300, -1e300}, {infinity, 0}, {std::nan(""), 0.05}}) {
    EXPECT_EQ(track.reflectance(at, 0.008), 1) << at.x_m;
  }
}

TEST(Track, OfNoFootprintIsThePixel) {
  const Track track = half_black(0.01);
  EXPECT_NEAR(track.reflectance({0.055, 0.055}, 0), 0, 1e-6);
  EXPECT_NEAR(track.reflectance({0.155, 0.055}, 0), 1, 1e-6);
}

TEST(Track, YCountsFromTheLowerEdge) {
  std::vector<std::uint8_t> grey(10 * 10, 255);
  for (std::size_t i = 90; i < 100; ++i) grey[i] = 0;  // the lowest row
  const std::string png = write_png(grey, 10, "row");
  const Track track = load(png, 0.01);
  std::filesystem::remove(png);
  EXPECT_NEAR(track.reflectance({0.05, 0.005}, 0.004), 0, 1e-6);
  EXPECT_NEAR(track.reflectance({0.05, 0.095}, 0.004), 1, 1e-6);
}

TEST(Track, TransparencyIsWhiteAndColoursBecomeGrey) {
  const std::vector<std::uint8_t> rgba = {0, 0, 0, 255, 0,   0,
                                          0, 0, 0, 0,   255, 255};  // black, transparent black, blue
  const std::string png = std::filesystem::temp_directory_path() / "tessera_rgba.png";
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 3;
  image.height = 1;
  image.format = PNG_FORMAT_RGBA;
  ASSERT_NE(png_image_write_to_file(&image, png.c_str(), 0, rgba.data(), 0, nullptr), 0);
  const Track track = load(png, 0.01);
  std::filesystem::remove(png);
  EXPECT_EQ(track.pixels()[0], 0);
  EXPECT_EQ(track.pixels()[1], 255);
  EXPECT_GT(track.pixels()[2], 10);
  EXPECT_LT(track.pixels()[2], 128);
}

TEST(Track, SaysWhyAPictureDoesNotLoad) {
  const std::string text = std::filesystem::temp_directory_path() / "tessera_no.png";
  std::ofstream(text) << "not a picture at all";
  struct Case {
    std::string file;
    double scale;
    std::string part;
  };
  for (const Case& c : {Case{"/nowhere/track.png", 0.005, "/nowhere/track.png: No such file"},
                        Case{text, 0.005, "PNG"}, Case{std::filesystem::temp_directory_path(), 0.005, ": "},
                        Case{shipped_track("oval.png"), 0, "positive"},
                        Case{shipped_track("oval.png"), std::nan(""), "positive"}}) {
    const auto track = Track::load(c.file, c.scale);
    EXPECT_FALSE(track) << c.file;
    EXPECT_NE(track.problem().find(c.part), std::string::npos) << track.problem();
  }
  std::filesystem::remove(text);
}

}  // namespace
