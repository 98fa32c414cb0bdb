#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/devices/buffer.hpp"
#include "sim/devices/kinds.hpp"
#include "sim/devices/noise.hpp"
#include "sim/devices/options.hpp"
#include "sim/engine/elements.hpp"
#include "sim/engine/physics.hpp"
#include "tessera/device.hpp"

namespace tessera::sim {

/// The element that a target names. Throws DeviceError.
[[nodiscard]] int element_of(const Physics& physics, mjtObj type, const DriverRequest& request,
                             const std::string& name);
/// Takes elements for the device of the request, which writes them. Throws DeviceError, as Writers::claim.
void claim(const DeviceContext& context, const DriverRequest& request, mjtObj type,
           std::span<const int> elements);
/// The one target. Throws DeviceError if there are several.
[[nodiscard]] const std::string& only_target(const DriverRequest& request);
/// A target that is a body or a site; bodies are looked up first.
struct FrameTarget {
  mjtObj type = mjOBJ_BODY;
  int id = 0;
};
[[nodiscard]] FrameTarget frame_target(const Physics& physics, const DriverRequest& request,
                                       const std::string& name);

/// A receptor that reads a row of numbers. `look` has exclusive access to the physics; `distort` adds noise.
/// Reading throws std::runtime_error once the physics has failed.
using Look = std::function<void(const Physics& physics, std::span<double> numbers)>;
using Distort = std::function<void(std::span<double> numbers)>;
[[nodiscard]] std::unique_ptr<RealReceptor> reading(std::shared_ptr<Simulation> simulation, Buffer buffer,
                                                    Look look, Distort distort = {});

/// An effector that takes a row of numbers. `act` returns false to refuse them. Writing throws
/// std::runtime_error once the physics has failed. Numbers that are not finite never reach `act`.
using Act = std::function<bool(Physics& physics, std::span<const double> numbers)>;
[[nodiscard]] std::unique_ptr<RealEffector> commanding(std::shared_ptr<Simulation> simulation, Buffer buffer,
                                                       Act act);

}  // namespace tessera::sim
