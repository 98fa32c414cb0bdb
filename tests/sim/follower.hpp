#pragma once

#include <string>

#include "sim/trace.hpp"
#include "tessera/device.hpp"

/// The paper's controller without the net: its table at the rates of the example, with the delays that the
/// pipeline sensor -> control -> motor may have.
struct Follower {
  double linear_mps = 0.2, angular_radps = 2;
  int sensor_delay_ms = 20;  ///< age of the readings when control takes them
  int motor_delay_ms = 70;   ///< from the table's answer to the wheels
  bool search = false;  ///< cross gaps: go on straight, then turn to the side where the line was last seen
};

/// Drives in `world` (replaces its trace) and reads the trace. Throws std::runtime_error if a step fails.
tessera::sim::Trace drive(const Follower& follower, tessera::WorldOptions world, double for_s);
/// The same in a world of any simulator that has the three eyes and the two wheels. It is left unfinished.
void drive(const Follower& follower, tessera::World& world, double for_s);
