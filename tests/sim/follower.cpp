#include "follower.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <deque>
#include <filesystem>
#include <stdexcept>

#include "read_trace.hpp"
#include "world_library.hpp"

namespace {

constexpr double wheel_radius_m = 0.03;
constexpr double wheel_distance_m = 0.16;

struct Velocity {
  double linear = 0, angular = 0;  ///< m/s; rad/s, clockwise positive
};

struct Line {
  bool left = false, middle = false, right = false;
  [[nodiscard]] bool any() const { return left || middle || right; }
};

/// The table of the paper, row by row.
Velocity table(const Line& line, double v, double w) {
  switch (line.left << 2 | line.middle << 1 | static_cast<int>(line.right)) {
    case 0b111:
      return {v, 0};
    case 0b110:
      return {v, -w / 15};
    case 0b100:
      return {v, -w};
    case 0b011:
      return {v, w / 15};
    case 0b001:
      return {v, w};
    default:
      return {-v, -w / 2};
  }
}

/// Straight on for 8 cm, then towards the side where the line was last seen.
class Search {
 public:
  Velocity next(const Line& line, const Follower& f) {
    if (line.any()) {
      lost_ms_ = 0;
      if (line.left != line.right) side_ = line.left ? -1 : 1;
      return table(line, f.linear_mps, f.angular_radps);
    }
    lost_ms_ += 50;
    if (lost_ms_ * f.linear_mps < 80) return {f.linear_mps, 0};
    return {f.linear_mps / 2, side_ * f.angular_radps / 2};
  }

 private:
  double lost_ms_ = 0;
  double side_ = 1;
};

class Robot {
 public:
  Robot(tessera::World& world) {
    std::string error;
    for (const std::string name : {"left", "middle", "right"}) {
      auto eye = world.receptor(
          tessera::request_for<double>({"robot.sensor." + name, "reflectance", {"eye_" + name}, {}}), error);
      if (!eye) throw std::runtime_error(error);
      eyes_.at(count_++) = std::move(eye);
    }
    left_ = world.effector(tessera::request_for<double>({"robot.motor.left", "velocity", {"wheel_left"}, {}}),
                           error);
    right_ = world.effector(
        tessera::request_for<double>({"robot.motor.right", "velocity", {"wheel_right"}, {}}), error);
    if (!left_ || !right_) throw std::runtime_error(error);
  }

  Line look() { return {dark(0), dark(1), dark(2)}; }

  void go(const Velocity& velocity) {
    const double turn = velocity.angular * wheel_distance_m / 2;
    write(*left_, (velocity.linear + turn) / wheel_radius_m);
    write(*right_, (velocity.linear - turn) / wheel_radius_m);
  }

 private:
  bool dark(std::size_t eye) {
    std::array<std::byte, sizeof(double)> bytes{};
    double light = 1;
    if (!eyes_.at(eye)->read(bytes)) throw std::runtime_error("no reading");
    std::memcpy(&light, bytes.data(), sizeof light);
    return light < 0.5;
  }
  static void write(tessera::RealEffector& wheel, double velocity) {
    if (!wheel.write(std::as_bytes(std::span(&velocity, 1)))) throw std::runtime_error("wheel refused");
  }

  std::array<std::unique_ptr<tessera::RealReceptor>, 3> eyes_;
  std::size_t count_ = 0;
  std::unique_ptr<tessera::RealEffector> left_, right_;
};

struct Command {
  int due_ms;
  Velocity velocity;
};

}  // namespace

tessera::sim::Trace drive(const Follower& follower, tessera::WorldOptions options, double for_s) {
  static std::atomic<int> runs = 0;
  options.trace = std::filesystem::temp_directory_path() /
                  ("tessera_drive_" + std::to_string(getpid()) + "_" + std::to_string(runs++) + ".csv");
  std::string error;
  const auto world = open_world(options, error);
  if (!world) throw std::runtime_error(error);
  drive(follower, *world, for_s);
  if (!world->finish(error)) throw std::runtime_error(error);
  auto trace = tessera::sim::read_trace(options.trace);
  std::filesystem::remove(options.trace);
  if (!trace) throw std::runtime_error(trace.problem());
  return *trace;
}

void drive(const Follower& follower, tessera::World& world, double for_s) {
  Robot robot(world);
  Search search;
  Line seen;
  std::deque<Command> commands;
  for (int ms = 0; ms < static_cast<int>(for_s * 1000); ms += 10) {
    world.advance_to(tessera::Time(std::chrono::milliseconds(ms)));
    if ((ms + follower.sensor_delay_ms) % 50 == 0) seen = robot.look();
    if (ms % 50 == 0) {
      const Velocity velocity = follower.search ? search.next(seen, follower)
                                                : table(seen, follower.linear_mps, follower.angular_radps);
      commands.push_back({ms + follower.motor_delay_ms, velocity});
    }
    while (!commands.empty() && commands.front().due_ms <= ms) {
      robot.go(commands.front().velocity);
      commands.pop_front();
    }
  }
}
