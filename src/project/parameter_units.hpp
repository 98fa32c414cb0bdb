#pragma once

#include <string>
#include <string_view>

#include "spec/model/model.hpp"

namespace tessera::project {

/// The value of a parameter in the form of the controller, without a unit: "5 cm" for a parameter in m is
/// "0.05". The same holds for each element of an array "[5 cm, 3 cm]". Other texts, and values of parameters
/// that are no numbers, stay as they are.
///
/// path: "v", "robot.control.v", "robot[1].control.v".
/// Throws std::runtime_error, with the number to write, if the unit is not of the parameter's quantity.
[[nodiscard]] std::string without_unit(const spec::Model& model, std::string_view path,
                                       const std::string& value);

}  // namespace tessera::project
