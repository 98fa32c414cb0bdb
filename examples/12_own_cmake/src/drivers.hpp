#pragma once

#include <optional>
#include <random>
#include <tessera/device.hpp>

namespace approach {

/// The cart that the simulated drivers move and see: its distance from the wall.
inline double simulated_distance_m = 0;

class SimulatedEcho final : public tessera::Receptor<double> {
 public:
  explicit SimulatedEcho(const tessera::DriverSetup& setup)
      : start_m_(setup.number("start", "m")), noise_(0, setup.number("noise", "m")) {}
  bool open() override {
    simulated_distance_m = start_m_;
    return true;
  }
  std::optional<double> read() override { return simulated_distance_m + noise_(random_); }

 private:
  double start_m_;
  std::normal_distribution<double> noise_;
  std::mt19937 random_{1};
};

class SimulatedWheel final : public tessera::Effector<double> {
 public:
  explicit SimulatedWheel(const tessera::DriverSetup& setup)
      : step_s_(tessera::seconds(setup.duration("step"))) {}
  bool write(const double& speed) override {
    simulated_distance_m -= speed * step_s_;
    return true;
  }

 private:
  double step_s_;
};

}  // namespace approach
