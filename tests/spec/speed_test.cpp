#include <chrono>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

/// The line follower as agent `name`, written out.
std::string agent(const std::string& name) {
  return "  " + name +
         ":\n    control:\n      rate: 20 Hz\n      inputs:  { line: LineReading }\n      outputs: { motion: "
         "Velocity }\n"
         "      behaviours:\n        init:   { terminal: true, next: follow }\n        follow: {}\n"
         "    receptors:\n      sensor:\n        rate: 50 Hz\n        real:\n          left: float64\n"
         "          middle: float64\n          right: float64\n        outputs: { line: LineReading }\n"
         "        behaviours: { watch: {} }\n    effectors:\n      motor:\n        rate: 50 Hz\n"
         "        inputs:  { velocity: Velocity }\n        real:    { left: float64 rad/s, right: float64 "
         "rad/s }\n"
         "        safe:    { left: 0, right: 0 }\n        stale:   500 ms\n        behaviours: { drive: {} "
         "}\n";
}

TEST(Speed, AThousandAgentsWrittenOutAreReadInAMoment) {
  std::string text =
      "tessera: 1\nsystem: many\ntypes:\n  LineReading: { left: bool, middle: bool, right: bool }\n"
      "  Velocity: { linear: float64 m/s, angular: float64 rad/s }\nagents:\n";
  std::string channels = "channels:\n";
  for (int i = 0; i < 1000; ++i) {
    const std::string name = "robot_" + std::to_string(i);
    text += agent(name);
    channels += "  - " + name + ".sensor.line -> " + name + ".control.line\n  - { from: " + name +
                ".control.motion, to: " + name + ".motor.velocity, receive: blocking, timeout: 200 ms }\n";
  }
  const auto begin = std::chrono::steady_clock::now();
  const Reading reading(text + channels);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(reading.model->agents.size(), 1000U);
  EXPECT_EQ(reading.model->channels.size(), 2000U);
  RecordProperty("seconds", std::to_string(taken.count()));
  // Well under a second in a release; the bound allows for sanitizers and a busy machine.
  EXPECT_LT(taken.count(), 20.0);
}

}  // namespace
}  // namespace tessera::spec
