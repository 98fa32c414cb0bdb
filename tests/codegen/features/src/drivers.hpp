#pragma once

#include <array>
#include <optional>
#include <tessera/device.hpp>
#include <vector>

#include "types.hpp"

namespace features {

/// Sees a wall that comes nearer.
class Lidar : public tessera::Receptor<std::array<float, 16>> {
 public:
  std::optional<std::array<float, 16>> read() override {
    std::array<float, 16> ranges{};
    ranges.fill(distance_ -= 0.01F);
    return ranges;
  }

 private:
  float distance_ = 10;
};

namespace devices {

/// Remembers all commands, for all to see.
template <class T>
class Sink : public tessera::Effector<T> {
 public:
  inline static std::vector<T> commands;

  bool write(const T& value) override {
    commands.push_back(value);
    return true;
  }
};

using Grip = Sink<float>;
using PoseSink = Sink<Pose>;
using JointSink = Sink<std::array<double, 3>>;

}  // namespace devices
}  // namespace features
