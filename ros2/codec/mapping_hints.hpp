#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "ros2/codec/translator.hpp"
#include "ros2/codec/value_type.hpp"
#include "ros2/definitions/type.hpp"
#include "tessera/nearest.hpp"

/// Hints for mistakes in a mapping.
namespace tessera::ros2 {

[[nodiscard]] std::vector<std::string> field_names(const Structure& structure);
[[nodiscard]] std::vector<std::string> member_names(const ValueType& type);
/// "did you mean 'x'?", or all names if none is near.
[[nodiscard]] Hint hint_of(std::string_view word, const std::vector<std::string>& names,
                           std::string_view owner);

/// For a field of the buffer that the message does not have by that name at that place. proposed: the fields
/// of the message that hints have named.
[[nodiscard]] Hint missing_member_hint(const ValueType::Member& member, const std::string& value_path,
                                       const Structure& structure, const std::string& message_path,
                                       Direction direction, std::set<std::string>& proposed);
/// For an element of the buffer with a field that the element of the message does not have: a hint with the
/// entries of `fields` for the whole element. A field is that of the same name and a type that fits, wherever
/// it lies in the element, or else the first one of such a type. Empty: no field is missing, or one has no
/// such type.
[[nodiscard]] std::string fields_of_elements(const ValueType& value, const std::string& value_path,
                                             const Structure& structure, const std::string& message_path,
                                             Direction direction);
/// The type of a buffer that takes this field of the message.
[[nodiscard]] std::string fitting_type(const Translator::Step& step);

}  // namespace tessera::ros2
