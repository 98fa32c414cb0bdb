#include "ros2/codec/mapping_hints.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "ros2/codec/cdr.hpp"
#include "ros2/codec/field_paths.hpp"

namespace tessera::ros2 {

namespace {

/// Whether the type of the message corresponds to that of the buffer: both or neither an array, and each
/// value converts exactly.
bool may_fit(const ValueType& value, const Type& type, Direction direction) {
  if ((value.count > 0) != (type.repeat != Type::Repeat::once)) return false;
  if (value.primitive == Primitive::structure || type.primitive == Primitive::structure)
    return value.primitive == type.primitive;
  return direction == Direction::receive ? converts_exactly(type.primitive, value.primitive)
                                         : converts_exactly(value.primitive, type.primitive);
}

/// The path of the nearest field with a type that fits the member, and with its name if `by_name`; empty:
/// there is none. without: paths that do not count.
std::string find_inside(const ValueType::Member& member, const Structure& structure, bool by_name,
                        Direction direction, const std::set<std::string>& without) {
  constexpr int deepest = 8;
  std::vector<std::pair<const Structure*, std::string>> level{{&structure, ""}};
  for (int depth = 0; depth < deepest && !level.empty(); ++depth) {
    std::vector<std::pair<const Structure*, std::string>> below;
    for (const auto& [one, path] : level)
      for (const Field& field : one->fields) {
        const std::string here = member_path(path, field.name);
        if ((!by_name || field.name == member.name) && may_fit(member.type, field.type, direction) &&
            !without.contains(here))
          return here;
        if (field.type.structure != nullptr && field.type.repeat == Type::Repeat::once)
          below.emplace_back(field.type.structure.get(), here);
      }
    level = std::move(below);
  }
  return {};
}

}  // namespace

std::vector<std::string> field_names(const Structure& structure) {
  std::vector<std::string> names;
  for (const Field& field : structure.fields) names.push_back(field.name);
  return names;
}

std::vector<std::string> member_names(const ValueType& type) {
  std::vector<std::string> names;
  for (const ValueType::Member& member : type.members) names.push_back(member.name);
  return names;
}

Hint hint_of(std::string_view word, const std::vector<std::string>& names, std::string_view owner) {
  if (Hint guess = did_you_mean(word, names); !guess.empty()) return guess;
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return std::string(owner) + " has " + (list.empty() ? "no fields" : list);
}

Hint missing_member_hint(const ValueType::Member& member, const std::string& value_path,
                         const Structure& structure, const std::string& message_path, Direction direction,
                         std::set<std::string>& proposed) {
  std::string found = find_inside(member, structure, /*by_name=*/true, direction, {});
  if (Hint guess = did_you_mean(member.name, field_names(structure)); found.empty() && !guess.empty())
    return guess;
  if (found.empty()) found = find_inside(member, structure, /*by_name=*/false, direction, proposed);
  if (found.empty()) return hint_of(member.name, field_names(structure), structure.name);
  proposed.insert(found);
  return "say which fields correspond: fields: { " + member_path(message_path, found) + ": " +
         without_numbers(member_path(value_path, member.name)) + " }";
}

std::string fields_of_elements(const ValueType& value, const std::string& value_path,
                               const Structure& structure, const std::string& message_path,
                               Direction direction) {
  if (value_path.find('[') != std::string::npos) return {};  // an array in an element has no names
  std::string entries;
  bool missing = false, guessed = false;
  std::set<std::string> used;
  for (const bool by_name : {true, false})
    for (const ValueType::Member& member : value.members) {
      const std::string named = find_inside(member, structure, /*by_name=*/true, direction, {});
      if (named.empty() == by_name) continue;
      const std::string found =
          by_name ? named : find_inside(member, structure, /*by_name=*/false, direction, used);
      if (found.empty()) return {};
      used.insert(found);
      missing = missing || found != member.name;
      guessed = guessed || !by_name;
      entries += (entries.empty() ? "" : ", ") + message_path + "." + found + ": " +
                 member_path(value_path, member.name);
    }
  if (!missing) return {};
  const std::string example = guessed ? ", for example" : value_path.empty() ? ":" : "";
  return value_path.empty() ? "say which fields correspond" + example + " fields: { " + entries + " }"
                            : "say which ones correspond" + example + (guessed ? "" : ",") +
                                  " beside the others in `fields`: { " + entries + " }";
}

std::string fitting_type(const Translator::Step& step) {
  if (step.type.primitive == Primitive::structure) {
    const std::string name = step.type.refers.substr(step.type.refers.rfind('/') + 1);
    if (step.type.repeat == Type::Repeat::sequence)
      return "it is a sequence: a buffer such as Element<=16, where Element is a structure with fields "
             "of " +
             name + ", does";
    if (step.type.repeat == Type::Repeat::array)
      return "it is an array: a buffer Element[" + std::to_string(step.type.count) +
             "], where Element is a structure with fields of " + name + ", does";
    return "map its fields one by one, or give the buffer a structure";
  }
  std::string type = name_of(step.type.primitive);
  if (step.type.string_bound > 0) type += "<=" + std::to_string(step.type.string_bound);
  if (step.type.repeat == Type::Repeat::array) type += "[" + std::to_string(step.type.count) + "]";
  if (step.type.repeat == Type::Repeat::sequence)
    type += step.type.count > 0 ? "<=" + std::to_string(step.type.count) : "<=16";
  return "a buffer of type " + type + " does" +
         (step.type.repeat == Type::Repeat::sequence
              ? ": it has 0 to " + std::to_string(step.type.count > 0 ? step.type.count : std::uint32_t{16}) +
                    " elements"
              : "");
}

}  // namespace tessera::ros2
