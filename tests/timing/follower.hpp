// The line follower of docs/theory/timing.md.
#pragma once

#include <string>
#include <vector>

#include "../spec/spec_reading.hpp"
#include "timing/declared.hpp"

namespace tessera::timing {

inline constexpr Time ms = 1'000'000;

/// The line follower. The parts that an alternative changes are arguments.
struct Follower {
  std::string sensor = "rate: 50 Hz", control = "rate: 20 Hz", motor = "rate: 50 Hz";
  std::string line = "robot.sensor.line -> robot.control.line";
  std::string motion =
      "{ from: \"robot.control.motion\", to: \"robot.motor.motion\", receive: blocking, timeout: 200 ms }";
  std::string sensor_takes = "takes: 1..2 ms,", count{};
  std::string timing{};  ///< the section; empty: there is none

  [[nodiscard]] std::string text() const {
    return "tessera: 1\nsystem: demo\nagents:\n  robot:\n" + count + "    control: { " + control +
           ", inputs: { line: float64 }, outputs: { motion: float64 },\n"
           "      behaviours: { follow: { takes: 2..8 ms, next: follow } } }\n"
           "    receptors: { sensor: { " +
           sensor +
           ", real: { light: float64 }, outputs: { line: float64 },\n"
           "      behaviours: { look: { " +
           sensor_takes +
           " next: look } } } }\n"
           "    effectors: { motor: { " +
           motor +
           ", inputs: { motion: float64 }, real: { speed: float64 },\n"
           "      behaviours: { drive: { takes: 1..2 ms, next: drive } } } }\n"
           "channels:\n  - " +
           line + "\n  - " + motion + "\n" + timing;
  }
};

/// The channel to the motor, which then does not wait.
inline const std::string no_waits = "robot.control.motion -> robot.motor.motion";

struct Judged {
  explicit Judged(const Follower& follower) : reading(follower.text()) {
    if (!reading.model) return;
    declared = timing::declared(*reading.model);
    const Bounds bounds(declared.system);
    for (const DeclaredChain& chain : declared.chains)
      verdicts.push_back(judge(declared, *reading.model, bounds, chain));
  }
  spec::Reading reading;
  Declared declared;
  std::vector<ChainVerdict> verdicts;
};

}  // namespace tessera::timing
