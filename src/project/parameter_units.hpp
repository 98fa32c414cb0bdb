#pragma once

#include <string>
#include <string_view>

#include "spec/model/model.hpp"

namespace tessera::project {

/// The value of a parameter as the controller takes it, without a unit: "5 cm" of a parameter in m is "0.05".
/// The same for each element of "[5 cm, 3 cm]" of an array. What is no quantity, or of a parameter that is no number, stays as it is.
///
/// path: "v", "robot.control.v", "robot[1].control.v".
/// Throws std::runtime_error, with the number to write, if the unit is not of the parameter's quantity.
[[nodiscard]] std::string without_unit(const spec::Model& model, std::string_view path,
                                       const std::string& value);

}  // namespace tessera::project
