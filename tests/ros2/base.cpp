// A robot base with ROS 2 over Fast DDS that also simulates its world: it drives in a room of 6 m x 6 m, and
// sends scans and odometry. For examples/10_ros2_base.
//
//     ros2_base [DOMAIN [SECONDS]]
//
// It ends after that time, or when a controller has come and gone. At the end it prints a summary: "commands
// 180, driven 2.31 m, nearest wall 0.62 m, last v 0.0".
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <thread>

#include "fast_peer.hpp"

namespace {

constexpr double half_room_m = 3, step_s = 0.02;
constexpr int rays = 36;

class Base {
 public:
  void obey(const fast::Twist& twist) {
    v_ = twist.linear_x;
    omega_ = twist.angular_z;
    ++commands_;
  }

  void move() {
    heading_ += omega_ * step_s;
    x_ = std::clamp(x_ + v_ * std::cos(heading_) * step_s, -half_room_m, half_room_m);
    y_ = std::clamp(y_ + v_ * std::sin(heading_) * step_s, -half_room_m, half_room_m);
    driven_ += std::abs(v_) * step_s;
    nearest_ = std::min(nearest_, half_room_m - std::max(std::abs(x_), std::abs(y_)));
  }

  [[nodiscard]] fast::LaserScan scan() const {
    fast::LaserScan scan;
    scan.header.frame_id = "laser";
    scan.angle_min = -std::numbers::pi_v<float>;
    scan.angle_increment = 2 * std::numbers::pi_v<float> / rays;
    scan.range_max = 5;
    for (int ray = 0; ray < rays; ++ray) {
      const auto range = static_cast<float>(distance(heading_ + (2.0 * ray / rays - 1) * std::numbers::pi));
      scan.ranges.push_back(range > scan.range_max ? std::numeric_limits<float>::infinity() : range);
    }
    return scan;
  }

  [[nodiscard]] fast::Odometry odometry() const {
    fast::Odometry odometry;
    odometry.header.frame_id = "odom";
    odometry.child_frame_id = "base_link";
    odometry.x = x_;
    odometry.y = y_;
    odometry.qz = std::sin(heading_ / 2);
    odometry.qw = std::cos(heading_ / 2);
    odometry.twist.linear_x = v_;
    return odometry;
  }

  void report() const {
    std::printf("commands %d, driven %.2f m, nearest wall %.2f m, last v %.1f\n", commands_, driven_,
                nearest_, v_);
  }

 private:
  /// To the walls of the room, in that direction.
  [[nodiscard]] double distance(double angle) const {
    const double dx = std::cos(angle), dy = std::sin(angle);
    const double far = 100;
    const double to_x = dx == 0 ? far : (std::copysign(half_room_m, dx) - x_) / dx;
    const double to_y = dy == 0 ? far : (std::copysign(half_room_m, dy) - y_) / dy;
    return std::min(to_x, to_y);
  }

  double x_ = 0, y_ = 0, heading_ = 0, v_ = 0, omega_ = 0, driven_ = 0, nearest_ = half_room_m;
  int commands_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const auto domain = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 0);
  const double seconds = argc > 2 ? std::atof(argv[2]) : 1e9;
  fast::Peer peer(domain);
  auto* const commands = peer.reader<fast::Twist>("rt/cmd_vel");
  auto* const scans = peer.writer<fast::LaserScan>("rt/scan", /*reliable=*/false);
  auto* const odometry = peer.writer<fast::Odometry>("rt/odom");
  Base base;
  bool met = false;
  const auto start = std::chrono::steady_clock::now();
  for (auto next = start; next - start < std::chrono::duration<double>(seconds);) {
    const bool here = fast::Peer::is_matched(*commands);
    if (met && !here) break;
    met = met || here;
    while (const auto twist = fast::Peer::take<fast::Twist>(*commands)) base.obey(*twist);
    base.move();
    auto scan = base.scan();
    auto moved = base.odometry();
    scans->write(&scan);
    odometry->write(&moved);
    std::this_thread::sleep_until(next += std::chrono::milliseconds(20));
  }
  base.report();
}
