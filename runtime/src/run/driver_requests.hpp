#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/device.hpp"

namespace tessera {

/// A finite number that is the whole text.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// Reads "robot.sensor.left=reflectance:eye_left,noise=0.01". Another form: nullopt and `error`.
[[nodiscard]] std::optional<DriverRequest> parse_driver(const std::string& text, std::string& error);

/// Reads the simulation file that `tessera simulate` writes (docs/use/worlds.md). It adds the devices and the checks
/// of what the run uses to `options`, and the placed models, checks and measures to `world`. false and `error`: the
/// file cannot be read, or is of another form.
[[nodiscard]] bool read_simulation_file(const std::string& path, RunOptions& options, WorldOptions& world,
                                        std::string& error);

}  // namespace tessera
