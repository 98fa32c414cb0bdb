#pragma once

#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "tessera/device.hpp"
#include "world_devices.hpp"

/// Worlds of a few primitives, and devices in them. A value of the type T is the real buffer.
namespace tessera::testing {

/// A two-link arm with sensors, a box on a free joint, a lamp on a ball joint, a moving obstacle, a weld.
inline constexpr const char* workshop = R"(<mujoco model="workshop">
  <size njmax="400" nconmax="100"/>
  <option timestep="0.002"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 0.1"/>
    <body name="arm" pos="0 0 0.5">
      <joint name="shoulder" type="hinge" axis="0 0 1" damping="0.5"/>
      <geom name="upper" type="capsule" fromto="0 0 0 0.3 0 0" size="0.02"/>
      <body name="hand" pos="0.3 0 0">
        <joint name="wrist" type="slide" axis="1 0 0" damping="5"/>
        <geom name="palm" type="box" size="0.03 0.03 0.03" pos="0.05 0 0"/>
        <site name="tip" pos="0.08 0 0" size="0.02"/>
      </body>
    </body>
    <body name="box" pos="1 0 0.1"><freejoint name="box"/>
      <geom name="crate" type="box" size="0.1 0.1 0.1" mass="1"/></body>
    <body name="lamp" pos="2 0 1"><joint name="swing" type="ball"/>
      <geom name="bulb" type="sphere" size="0.05" pos="0 0 -0.3" mass="0.2"/></body>
    <body name="gate" pos="0 2 0.5" mocap="true"><geom name="bar" type="box" size="0.5 0.05 0.5"/></body>
  </worldbody>
  <equality><weld name="grip" body1="hand" body2="box" active="false"/></equality>
  <actuator>
    <position name="shoulder" joint="shoulder" kp="20" ctrllimited="true" ctrlrange="-1.5 1.5"/>
    <position name="wrist" joint="wrist" kp="200" ctrllimited="true" ctrlrange="0 0.1"/>
  </actuator>
  <sensor>
    <jointpos name="shoulder" joint="shoulder"/>
    <accelerometer name="acceleration" site="tip"/>
    <gyro name="gyro" site="tip" noise="0.1" cutoff="3"/>
    <framequat name="turn" objtype="body" objname="lamp"/>
    <user name="own" dim="2" objtype="body" objname="arm" datatype="real" needstage="acc"/>
  </sensor>
</mujoco>)";

[[nodiscard]] inline std::unique_ptr<World> open_text(const std::string& name, const std::string& mjcf,
                                                      std::uint64_t seed = 1) {
  return open({.world = file_with(name + ".xml", mjcf), .seed = seed});
}

template <class T>
[[nodiscard]] std::unique_ptr<RealReceptor> receptor(World& world, DriverRequest request) {
  std::string error;
  auto made = world.receptor(request_for<T>(std::move(request)), error);
  if (!made) throw std::runtime_error(error);
  return made;
}
template <class T>
[[nodiscard]] std::unique_ptr<RealEffector> effector(World& world, DriverRequest request) {
  std::string error;
  auto made = world.effector(request_for<T>(std::move(request)), error);
  if (!made) throw std::runtime_error(error);
  return made;
}
template <class T>
[[nodiscard]] T read_as(RealReceptor& device) {
  T value{};
  if (!device.read(std::as_writable_bytes(std::span(&value, 1)))) throw std::runtime_error("no value");
  return value;
}
template <class T>
[[nodiscard]] bool write_as(RealEffector& device, const T& value) {
  return device.write(std::as_bytes(std::span(&value, 1)));
}

}  // namespace tessera::testing
