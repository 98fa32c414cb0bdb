#pragma once

#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <tessera/device.hpp>

#include "arm/encoders.hpp"
#include "arm/joints.hpp"

// The devices of this example are files, so that it runs on a desk: each command is a line.
namespace cell {

// ------------------------------------------------------------------------------- one driver, one real buffer

/// A motor behind a pin. The specification says which: `{ cpp: Motor, file: "cart_{i}.pwm", pin: 4 }`.
class Motor final : public tessera::Effector<double> {
 public:
  explicit Motor(const tessera::DriverSetup& setup)
      : file_(setup.text("file")),
        pin_(setup.integer("pin")),
        sign_(setup.flag_or("inverted", false) ? -1 : 1) {}

  bool open() override {
    stream_.open(file_);
    if (!stream_) throw std::runtime_error("cannot open " + file_);
    return true;
  }
  bool write(const double& duty) override {
    stream_ << "pin " << pin_ << " duty " << sign_ * duty << std::endl;
    return static_cast<bool>(stream_);
  }
  void close() override { stream_.close(); }

 private:
  std::string file_;
  std::int64_t pin_;
  int sign_;
  std::ofstream stream_;
};

// --------------------------------------------------------------- one driver, all real buffers of a subsystem

/// Six joints on one bus: one telegram per iteration. `arm::joints::Real` has the real buffers of arm.joints.
class JointBus final : public tessera::Effector<arm::joints::Real> {
 public:
  explicit JointBus(const tessera::DriverSetup& setup)
      : port_(setup.text("port")), timeout_(setup.duration("timeout")) {}

  bool open() override {
    stream_.open(port_);
    return static_cast<bool>(stream_);
  }
  bool write(const arm::joints::Real& v) override {
    for (const double velocity : {v.v1, v.v2, v.v3, v.v4, v.v5, v.v6}) stream_ << velocity << ' ';
    stream_ << std::endl;
    return static_cast<bool>(stream_);
  }
  void close() override { stream_.close(); }

  // The bus stops the joints by itself if it hears nothing for `timeout`.
  [[nodiscard]] tessera::Duration heartbeat_period() const override { return timeout_ / 2; }
  void heartbeat() override { stream_ << "alive" << std::endl; }

 private:
  std::string port_;
  tessera::Duration timeout_;
  std::ofstream stream_;
};

/// Reads the six positions of the last telegram: "q1 q2 q3 q4 q5 q6".
class EncoderBus final : public tessera::Receptor<arm::encoders::Real> {
 public:
  explicit EncoderBus(const tessera::DriverSetup& setup) : port_(setup.text("port")) {}

  bool open() override { return static_cast<bool>(std::ifstream(port_)); }
  std::optional<arm::encoders::Real> read() override {
    std::ifstream stream(port_);
    arm::encoders::Real q;
    if (stream >> q.q1 >> q.q2 >> q.q3 >> q.q4 >> q.q5 >> q.q6) return q;
    return std::nullopt;
  }

 private:
  std::string port_;
};

// ----------------------------------------------------------------------------------- simulated drivers

/// The joints of a simulated arm, by agent: what SimulatedJoints moves and SimulatedEncoders sees.
inline std::array<double, 6>& simulated_positions(const std::string& agent) {
  static std::map<std::string, std::array<double, 6>> positions;
  return positions[agent];
}

class SimulatedJoints final : public tessera::Effector<arm::joints::Real> {
 public:
  explicit SimulatedJoints(const tessera::DriverSetup& setup)
      : agent_(setup.agent()), step_s_(tessera::seconds(setup.duration("step"))) {}
  bool open() override {
    simulated_positions(agent_).fill(0);
    return true;
  }
  bool write(const arm::joints::Real& v) override {
    const std::array velocities{v.v1, v.v2, v.v3, v.v4, v.v5, v.v6};
    std::array<double, 6>& positions = simulated_positions(agent_);
    for (std::size_t joint = 0; joint < positions.size(); ++joint)
      positions[joint] += velocities[joint] * step_s_;
    return true;
  }

 private:
  std::string agent_;
  double step_s_;
};

class SimulatedEncoders final : public tessera::Receptor<arm::encoders::Real> {
 public:
  explicit SimulatedEncoders(const tessera::DriverSetup& setup) : agent_(setup.agent()) {}
  std::optional<arm::encoders::Real> read() override {
    const std::array<double, 6>& q = simulated_positions(agent_);
    return arm::encoders::Real{q[0], q[1], q[2], q[3], q[4], q[5]};
  }

 private:
  std::string agent_;
};

class SimulatedMotor final : public tessera::Effector<double> {
  bool write(const double&) override { return true; }
};

}  // namespace cell
