#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/compose/compose.hpp"

namespace tessera::testing {

/// A model of these tests, such as "rover.xml".
[[nodiscard]] std::string model(const std::string& name);
[[nodiscard]] std::string text_of(const std::string& file);
/// Writes a file into a folder of this test process, and returns its path.
[[nodiscard]] std::string file_with(const std::string& name, std::string_view content);
/// A free rover or the like in the world of these tests.
[[nodiscard]] sim::Placement placed(const std::string& name, const std::string& file, double x_m = 0,
                                    double y_m = 0);
/// Composed and compiled. A problem fails the test, and ends it.
[[nodiscard]] sim::ComposedWorld loaded(const std::vector<sim::Placement>& placements,
                                        const std::string& world = model("world.xml"));
/// The problem of composing and compiling. If there is none, the test fails, and ends.
[[nodiscard]] std::string problem_of(const std::vector<sim::Placement>& placements,
                                     const std::string& world = model("world.xml"));

}  // namespace tessera::testing
