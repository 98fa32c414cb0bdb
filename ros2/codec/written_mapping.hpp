#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ros2/codec/plan.hpp"

namespace tessera::ros2 {

/// A mapping as it stands in the tables of a controller: "linear.x=v, angular.z=omega", or "data" for all of
/// the buffer; "shoulder, elbow".
[[nodiscard]] Mapping written_mapping(std::string_view fields, std::string_view names, std::string frame_id);
/// "a, b", without blanks around the parts.
[[nodiscard]] std::vector<std::string> parts_of_list(std::string_view list);

}  // namespace tessera::ros2
