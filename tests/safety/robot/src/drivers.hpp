#pragma once

#include <unistd.h>

#include "command_log.hpp"
#include "harm.hpp"
#include "tessera/device.hpp"

/// Logs its commands; the first device may suffer harm inside its driver.
template <unsigned Number>
class Logged : public tessera::Effector<double>, public tessera::Guarded {
 public:
  bool write(const double& value) override {
    command_log::Log* const log = command_log::own();
    if (log == nullptr) return false;
    command_log::note(*log, Number, value);
    while (Number == 0 && value == 0 && log->hangs_when_safe) pause();
    if (Number == 0 && value != 0) suffer(command_log::Place::driver);
    return true;
  }
};
class Left : public Logged<0> {};
class Right : public Logged<1> {};
class Joint : public Logged<2> {};

/// No guardian can reach it, and it is not logged.
class Lamp : public tessera::Effector<double> {
 public:
  bool write(const double& /*value*/) override { return true; }
};
