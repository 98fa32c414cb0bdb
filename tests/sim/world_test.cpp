#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "drawing.hpp"
#include "read_trace.hpp"
#include "tessera/device.hpp"
#include "world_devices.hpp"
#include "world_library.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

std::string bytes_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// Drives with those wheel speeds for that time; returns the trace's file.
std::string driven(double left, double right, std::chrono::milliseconds time, const std::string& name) {
  const WorldOptions options{.world = line_world(),
                             .track = {},
                             .start_x_m = 1,
                             .start_y_m = 2,
                             .start_heading_rad = 0.5,
                             .trace = temporary(name)};
  const auto world = open(options);
  std::string error;
  const auto left_wheel = world->effector(wheel_request, error);
  const auto right_wheel =
      world->effector(request_for<double>({"robot.motor.right", "velocity", {"wheel_right"}, {}}), error);
  EXPECT_TRUE(write(*left_wheel, left));
  EXPECT_TRUE(write(*right_wheel, right));
  world->advance_to(Time(time));
  EXPECT_TRUE(world->finish(error)) << error;
  return options.trace;
}

TEST(World, WheelSpeedsMoveTheRobotAsTheyShould) {
  const auto straight = sim::read_trace(driven(5, 5, 10s, "straight.csv"));
  ASSERT_TRUE(straight) << straight.problem();
  const auto& last = straight->points.back();
  EXPECT_NEAR(std::hypot(last.x_m - 1, last.y_m - 2), 5 * 0.03 * 10, 0.02);
  EXPECT_NEAR(last.heading_rad, 0.5, 0.01);
  const auto turning = sim::read_trace(driven(-2, 2, 1s, "turning.csv"));
  ASSERT_TRUE(turning) << turning.problem();
  EXPECT_NEAR(turning->points.back().heading_rad, 0.5 + 2 * 2 * 0.03 / 0.16, 0.05);
}

TEST(World, TheTraceStartsAtTheStartAndHasAPointEveryTenMilliseconds) {
  const auto trace = sim::read_trace(driven(0, 0, 1s, "start.csv"));
  ASSERT_TRUE(trace) << trace.problem();
  ASSERT_EQ(trace->points.size(), 101U);
  EXPECT_NEAR(trace->points[0].x_m, 1, 1e-6);
  EXPECT_NEAR(trace->points[0].y_m, 2, 1e-6);
  EXPECT_NEAR(trace->points[0].heading_rad, 0.5, 1e-6);
  EXPECT_NEAR(trace->points[57].t_s, 0.57, 1e-9);
}

TEST(World, ATraceDoesNotDisturbWhatSensorsSee) {
  const auto readings = [](const std::string& trace) {
    const auto world = open({.world = line_world(),
                             .track = shipped_track("oval.png"),
                             .start_x_m = 1.2,
                             .start_y_m = 0.1,
                             .start_heading_rad = 0,
                             .trace = trace});
    std::string error;
    const auto sensor = world->receptor(eye_request, error);
    const auto left = world->effector(wheel_request, error);
    const auto right =
        world->effector(request_for<double>({"robot.motor.right", "velocity", {"wheel_right"}, {}}), error);
    std::vector<double> values;
    for (auto t = 0ms; t < 5s; t += 50ms) {
      EXPECT_TRUE(write(*left, 8));
      EXPECT_TRUE(write(*right, 8 + 0.3 * static_cast<double>(t / 1s)));
      world->advance_to(Time(t));
      values.push_back(read(*sensor));
    }
    return values;
  };
  EXPECT_EQ(readings(""), readings(temporary("undisturbed.csv")));
}

/// The world's robot twice.
std::string world_of_two() {
  std::string text = bytes_of(line_world());
  const auto renamed = [](std::string part) {
    for (const char* name : {"\"robot", "\"chassis", "\"caster", "\"eye_left", "\"eye_middle", "\"eye_right",
                             "\"wheel_left", "\"wheel_right"})
      for (std::size_t at = 0; (at = part.find(std::string(name) + '"', at)) != std::string::npos; ++at)
        part.insert(at + std::strlen(name), "_2");
    return part;
  };
  const auto double_between = [&](const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from);
    const std::string part = text.substr(begin, text.rfind(to) - begin);
    text.insert(text.rfind(to), renamed(part));
  };
  double_between("    <body name=\"robot\"", "  </worldbody>");
  double_between("    <velocity name=", "  </actuator>");
  return file_with("two.xml", text);
}

TEST(World, OfSeveralRobotsNoPathIsShownAsThatOfTheRobot) {
  for (const bool both : {false, true}) {
    const WorldOptions options{.world = world_of_two(), .trace = temporary("two.csv")};
    const auto world = open(options);
    std::string error;
    // The second one alone is the robot, though its joint is not the first.
    const auto mine =
        world->effector(request_for<double>({"b.motor.left", "velocity", {"wheel_left_2"}, {}}), error);
    ASSERT_TRUE(mine) << error;
    const auto other = both ? world->receptor(eye_request, error) : nullptr;
    world->advance_to(Time(100ms));
    ASSERT_TRUE(world->finish(error)) << error;
    const auto trace = sim::read_trace(options.trace);
    ASSERT_TRUE(trace) << trace.problem();
    EXPECT_EQ(trace->robots, both ? "robot, robot_2" : "");
    EXPECT_EQ(trace->points.size(), both ? 0U : 11U);
  }
}

TEST(World, AStartPoseSaidInPartKeepsTheRest) {
  const WorldOptions options{.world = line_world(), .start_y_m = 3, .trace = temporary("partial.csv")};
  const auto world = open(options);
  world->advance_to(Time(10ms));
  std::string error;
  ASSERT_TRUE(world->finish(error));
  const auto trace = sim::read_trace(options.trace);
  EXPECT_NEAR(trace->points[0].x_m, 0, 1e-6);
  EXPECT_NEAR(trace->points[0].y_m, 3, 1e-6);
}

TEST(World, TheSameRunWritesTheSameBytes) {
  const std::string first = bytes_of(driven(3, 4, 3s, "first.csv"));
  EXPECT_EQ(first, bytes_of(driven(3, 4, 3s, "second.csv")));
  EXPECT_GT(first.size(), 10'000U);
}

TEST(World, HowOftenTheClockStopsDoesNotMatterToThePath) {
  const auto path_in_steps_of = [](std::chrono::milliseconds step) {
    const WorldOptions options{.world = line_world(), .trace = temporary("steps.csv")};
    const auto world = open(options);
    std::string error;
    const auto left = world->effector(wheel_request, error);
    EXPECT_TRUE(write(*left, 4));
    for (auto t = 0ms; t <= 2s; t += step) world->advance_to(Time(t));
    EXPECT_TRUE(world->finish(error));
    return bytes_of(options.trace);
  };
  EXPECT_EQ(path_in_steps_of(5ms), path_in_steps_of(500ms));
}

TEST(World, NoiseComesFromTheSeedAndTheDevice) {
  const auto readings = [](std::uint64_t seed, const std::string& path) {
    const std::string grey = write_png(std::vector<std::uint8_t>(100, 128), 10, "grey");
    const auto world = open({
        .world = line_world(),
        .track = grey,
        .start_x_m = -0.07,
        .start_y_m = 0.025,
        .seed = seed,
    });
    std::filesystem::remove(grey);
    std::string error;
    const auto receptor =
        world->receptor(request_for<double>({path, "reflectance", {"eye_middle"}, {}}), error);
    std::vector<double> values;
    for (int i = 0; i < 1000; ++i) values.push_back(read(*receptor));
    return values;
  };
  const auto one = readings(1, "a.b.c");
  EXPECT_EQ(one, readings(1, "a.b.c"));
  EXPECT_NE(one, readings(2, "a.b.c"));
  EXPECT_NE(one, readings(1, "a.b.d"));
  double mean = 0;
  double squares = 0;
  for (const double v : one) mean += v / 1000, squares += v * v / 1000;
  EXPECT_NEAR(mean, 128 / 255.0, 0.002);
  EXPECT_NEAR(std::sqrt(squares - mean * mean), 0.01, 0.002);
}

TEST(World, NoiseIsAnOption) {
  const auto world = open({.world = line_world()});
  std::string error;
  const auto quiet =
      world->receptor(request_for<double>({"a", "reflectance", {"eye_left"}, {{"noise", 0}}}), error);
  EXPECT_EQ(read(*quiet), 1);
}

TEST(World, DevicesConvertToAndFromFloat32) {
  const auto read_single = [](RealReceptor& receptor) {
    float value = 0;
    EXPECT_TRUE(receptor.read(std::as_writable_bytes(std::span(&value, 1))));
    return value;
  };
  std::string error;
  const WorldOptions options{.world = line_world()};
  const auto wide = open(options), narrow = open(options);
  EXPECT_EQ(read_single(*narrow->receptor(request_for<float>(eye_request), error)),
            static_cast<float>(read(*wide->receptor(eye_request, error))));
  const auto path = [&](const std::string& name, auto speed) {
    const auto world = open({.world = line_world(), .track = {}, .trace = temporary(name)});
    EXPECT_TRUE(world->effector(request_for<decltype(speed)>(wheel_request), error)
                    ->write(std::as_bytes(std::span(&speed, 1))));
    world->advance_to(Time(1s));
    EXPECT_TRUE(world->finish(error)) << error;
    return bytes_of(temporary(name));
  };
  const std::string of_single = path("single.csv", 2.5F);
  EXPECT_EQ(of_single, path("double.csv", 2.5));
  EXPECT_NE(of_single, path("still.csv", 0.0));
}

TEST(World, DevicesOutliveIt) {
  auto world = open({.world = line_world()});
  std::string error;
  const auto receptor = world->receptor(eye_request, error);
  world.reset();
  EXPECT_GT(read(*receptor), 0.9);
}

TEST(World, DevicesMayBeUsedWhileItMoves) {
  const auto world = open({.world = line_world(), .track = shipped_track("oval.png")});
  std::string error;
  const auto receptor = world->receptor(eye_request, error);
  const auto effector = world->effector(wheel_request, error);
  std::thread sensor([&] {
    for (int i = 0; i < 2000; ++i) EXPECT_GE(read(*receptor), 0);
  });
  std::thread motor([&] {
    for (int i = 0; i < 2000; ++i) EXPECT_TRUE(write(*effector, i % 5));
  });
  for (int i = 0; i < 200; ++i) world->advance_to(Time(std::chrono::milliseconds(5 * i)));
  sensor.join();
  motor.join();
  EXPECT_TRUE(world->finish(error)) << error;
}

}  // namespace
}  // namespace tessera::testing
