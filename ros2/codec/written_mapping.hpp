#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ros2/codec/translator.hpp"

namespace tessera::ros2 {

/// Parses a mapping from the tables of a controller: "linear.x=v, angular.z=omega", or "data" for the whole
/// buffer; "shoulder, elbow".
[[nodiscard]] Mapping written_mapping(std::string_view fields, std::string_view names, std::string frame_id);
/// Fields of a service's buffer that are no part of its messages: "call", and "outcome" for the receptor of a
/// client, in this order.
[[nodiscard]] std::vector<OwnField> own_fields_of_service(bool has_outcome);
/// The mapping of the buffer of an action, which has fields of its own: "call", and "cancel" of a goal or "state" of
/// feedback and result.
[[nodiscard]] Mapping mapping_of_action(Mapping written, bool is_goal, Direction direction);
inline constexpr std::size_t call_field = 0, outcome_field = 1, cancel_field = 1, state_field = 1;

/// "a, b", without blanks around the parts.
[[nodiscard]] std::vector<std::string> parts_of_list(std::string_view list);

}  // namespace tessera::ros2
