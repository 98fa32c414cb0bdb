#include "ros2/definitions/type.hpp"

#include <algorithm>
#include <array>

namespace tessera::ros2 {
namespace {

struct PrimitiveFacts {
  const char* name;
  std::size_t size;
};
constexpr std::array primitive_facts = std::to_array<PrimitiveFacts>({{"bool", 1},
                                                                      {"int8", 1},
                                                                      {"uint8", 1},
                                                                      {"int16", 2},
                                                                      {"uint16", 2},
                                                                      {"int32", 4},
                                                                      {"uint32", 4},
                                                                      {"int64", 8},
                                                                      {"uint64", 8},
                                                                      {"float32", 4},
                                                                      {"float64", 8},
                                                                      {"string", 0},
                                                                      {"wstring", 0},
                                                                      {"message", 0}});

}  // namespace

const char* name_of(Primitive primitive) { return primitive_facts[static_cast<std::size_t>(primitive)].name; }

std::size_t size_of(Primitive primitive) { return primitive_facts[static_cast<std::size_t>(primitive)].size; }

std::string Type::text() const {
  std::string text = primitive == Primitive::structure ? refers : name_of(primitive);
  if (const std::size_t at = text.find("/msg/"); at != std::string::npos) text.erase(at, 4);
  if (string_bound > 0) text += "<=" + std::to_string(string_bound);
  if (repeat == Repeat::array) text += "[" + std::to_string(count) + "]";
  if (repeat == Repeat::sequence) text += count == 0 ? "[]" : "[<=" + std::to_string(count) + "]";
  return text;
}

const Field* Structure::find(const std::string& field) const {
  const auto found = std::ranges::find(fields, field, &Field::name);
  return found == fields.end() ? nullptr : &*found;
}

}  // namespace tessera::ros2
