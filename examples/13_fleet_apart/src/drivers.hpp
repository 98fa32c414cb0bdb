#pragma once

#include <tessera/device.hpp>

namespace convoy {

/// In place of hardware: wheels that turn as they are told.
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
