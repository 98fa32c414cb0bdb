#pragma once

#include <cstdint>
#include <tessera/device.hpp>

#include "say.hpp"

namespace ring {

/// Writes down each command and its origin: the controller, or the guardian when the controller has died.
class Lamp final : public tessera::Effector<std::uint64_t>, public tessera::Guarded {
 public:
  bool write(const std::uint64_t& brightness) override {
    say("lamp", brightness, static_cast<std::uint64_t>(getpid()));
    return true;
  }
};

}  // namespace ring
