#include "drivers/ros2_clock.hpp"

#include <chrono>

#include "drivers/ros2_library.hpp"

namespace tessera {
namespace {

constexpr Duration clock_interval = std::chrono::milliseconds(10);

}  // namespace

PublishedClock::PublishedClock(const std::string& interface) {
  auto* const make = reinterpret_cast<Ros2ClockMaker>(
      ros2_function({TESSERA_ROS2_BUILT, TESSERA_ROS2_INSTALLED}, ros2_clock_function));
  std::string error = "it cannot be made";
  clock_ = make(interface, error);
  if (clock_ == nullptr) throw DriverError(error);
  clock_->set(Duration::zero());
}

void PublishedClock::move_to(Time now) {
  clock_->set(now.time_since_epoch());
  publish(now);
}

void PublishedClock::publish(Time now) {
  clock_->publish(now.time_since_epoch());
  next_ = now + clock_interval;
}

}  // namespace tessera
