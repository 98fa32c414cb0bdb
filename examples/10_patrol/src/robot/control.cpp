#include "robot/control.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace patrol::robot::control {
namespace {

/// A place on the map, in metres and radians.
struct Pose {
  double x, y, heading;
};

constexpr std::array<Pose, 3> stations{
    {{2, 0, 0}, {2, 1.5, std::numbers::pi / 2}, {0, 1.5, std::numbers::pi}}};
constexpr std::array names{"to station 0", "to station 1", "to station 2"};
constexpr Pose dock{0, 0, 0};

/// The controller itself writes the number of the goal, and its cancel.
void go_to(const Pose& pose, Outputs& out) {
  out.goal.x = pose.x;
  out.goal.y = pose.y;
  out.goal.z = std::sin(pose.heading / 2);
  out.goal.w = std::cos(pose.heading / 2);
}

}  // namespace

/// Behaviour stand of robot.control. It has no goal of its own.
void stand(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.goal = Goal{};
  out.report.text = !in.battery.valid ? "waits for the battery" : in.wish.pause ? "paused" : "stands";
}

/// Behaviour to_station of robot.control.
void to_station(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  go_to(stations[static_cast<std::size_t>(memory.station)], out);
  out.report.text = names[static_cast<std::size_t>(memory.station)];
}

/// Behaviour next_station of robot.control.
void next_station(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  context.log("station {}", memory.station);
}

/// Behaviour recover of robot.control: some time for what stood in the way.
void recover(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.report.text = "recovers";
}

/// Behaviour to_dock of robot.control.
void to_dock(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  go_to(dock, out);
  out.report.text = "to the dock";
}

/// Behaviour charge of robot.control.
void charge(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.report.text = "charges"; }

}  // namespace patrol::robot::control
