#pragma once

#include <tessera/device.hpp>

#include "types.hpp"

// Devices that take every command, so that the robot runs on a desk.
namespace teleoperation {

class WheelsOfTest final : public tessera::Effector<Wheels> {
 public:
  bool write(const Wheels&) override { return true; }
};

class WinchOfTest final : public tessera::Effector<double> {
 public:
  bool write(const double&) override { return true; }
};

}  // namespace teleoperation
