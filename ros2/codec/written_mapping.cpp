#include "ros2/codec/written_mapping.hpp"

#include <algorithm>

#include "ros2/definitions/literals.hpp"

namespace tessera::ros2 {

std::vector<std::string> parts_of_list(std::string_view list) {
  std::vector<std::string> parts;
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    parts.emplace_back(trimmed(list.substr(0, comma)));
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return parts;
}

Mapping mapping_of_action(Mapping written, bool is_goal, Direction direction) {
  const OwnField number{
      "call", {Primitive::uint32, Primitive::uint64}, /*needed=*/true, "the number of the goal"};
  if (is_goal)
    written.own = {number, {"cancel", {Primitive::boolean}, /*needed=*/false, "the wish to cancel it"}};
  else
    written.own = {number, {"state", {Primitive::uint8}, /*needed=*/true, "the state of the goal"}};
  written.parts_may_be_empty = !is_goal && direction == Direction::receive;
  return written;
}

std::vector<OwnField> own_fields_of_service(bool has_outcome) {
  std::vector<OwnField> fields{
      {"call", {Primitive::uint32, Primitive::uint64}, /*needed=*/true, "the number of the call"}};
  if (has_outcome)
    fields.push_back({"outcome", {Primitive::uint8}, /*needed=*/false, "what became of the call"});
  return fields;
}

Mapping written_mapping(std::string_view fields, std::string_view names, std::string frame_id) {
  Mapping mapping;
  for (const std::string& part : parts_of_list(fields)) {
    const std::size_t equals = std::min(part.find('='), part.size());
    mapping.fields.emplace_back(part.substr(0, equals), part.substr(std::min(equals + 1, part.size())));
  }
  mapping.names = parts_of_list(names);
  mapping.frame_id = std::move(frame_id);
  return mapping;
}

}  // namespace tessera::ros2
