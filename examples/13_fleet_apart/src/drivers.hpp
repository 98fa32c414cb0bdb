#pragma once

#include <tessera/device.hpp>

namespace convoy {

/// Simulated hardware: wheels that turn as commanded.
class Wheels final : public tessera::Effector<double> {
 public:
  bool write(const double& speed) override {
    speed_ = speed;
    return true;
  }

 private:
  double speed_ = 0;
};

}  // namespace convoy
