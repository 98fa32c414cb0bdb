#pragma once

#include <memory>
#include <string>

#include "tessera/device.hpp"

namespace tessera::testing {

/// Devices of `line_world()`.
inline const DriverRequest eye_request =
    request_for<double>({"robot.sensor.left", "reflectance", {"eye_left"}, {}});
inline const DriverRequest wheel_request =
    request_for<double>({"robot.motor.left", "velocity", {"wheel_left"}, {}});

/// A world that opens. Throws std::runtime_error.
std::unique_ptr<World> open(const WorldOptions& options);

double read(RealReceptor& receptor);
bool write(RealEffector& effector, double value);

/// A path in the temporary directory, of this process alone.
std::string temporary(const std::string& name);
/// A new file there; returns its path.
std::string file_with(const std::string& name, const std::string& text);

}  // namespace tessera::testing
