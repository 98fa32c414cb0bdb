#pragma once

#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tessera/device.hpp>

#include "rover/base.hpp"
#include "rover/odometry.hpp"

// Simulated hardware: a rover that moves as commanded, at once. Its wheels and its odometry are two devices
// of one lane, so both use the same object.
namespace crossroads {

/// The positions of the rovers, by agent. Threads: any.
class Lane {
 public:
  [[nodiscard]] static Lane& of(const std::string& agent) {
    static std::mutex mutex;
    static std::map<std::string, Lane> lanes;
    const std::lock_guard lock(mutex);
    return lanes[agent];
  }

  void drive(const Motion& motion) {
    const std::lock_guard lock(mutex_);
    move();
    motion_ = motion;
  }
  [[nodiscard]] Joints joints() {
    const std::lock_guard lock(mutex_);
    move();
    return at_;
  }

 private:
  void move() {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - since_).count();
    since_ = now;
    at_.heading += motion_.turn * seconds;
    at_.x += motion_.ahead * std::cos(at_.heading) * seconds;
    at_.y += motion_.ahead * std::sin(at_.heading) * seconds;
  }

  using Clock = std::chrono::steady_clock;
  std::mutex mutex_;
  Joints at_{};
  Motion motion_{};
  Clock::time_point since_ = Clock::now();
};

class LaneBase final : public tessera::Effector<Motion> {
 public:
  explicit LaneBase(const tessera::DriverSetup& setup) : lane_(Lane::of(setup.agent())) {}
  bool write(const Motion& motion) override {
    lane_.drive(motion);
    return true;
  }

 private:
  Lane& lane_;
};

class LaneOdometry final : public tessera::Receptor<Joints> {
 public:
  explicit LaneOdometry(const tessera::DriverSetup& setup) : lane_(Lane::of(setup.agent())) {}
  std::optional<Joints> read() override { return lane_.joints(); }

 private:
  Lane& lane_;
};

}  // namespace crossroads
