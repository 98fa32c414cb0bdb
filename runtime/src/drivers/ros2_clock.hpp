#pragma once

#include <memory>
#include <string>

#include "tessera/ros2.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// Publishes the simulated time as /clock of ROS 2, every 10 ms of simulated time and at every instant with
/// an event.
class PublishedClock {
 public:
  /// Throws DriverError: no library, or no such interface.
  explicit PublishedClock(const std::string& interface);

  /// When to publish next, if no event happens before.
  [[nodiscard]] Time next() const { return next_; }
  /// Simulated time stands at `now`.
  void move_to(Time now);
  /// Simulated time is on its way to the next instant.
  void publish(Time now);

 private:
  std::unique_ptr<Ros2Clock> clock_;
  Time next_{};
};

}  // namespace tessera
