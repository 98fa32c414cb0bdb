#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

/// Messages of ROS 2 as their definitions (.msg, .srv) describe them.
namespace tessera::ros2 {

enum class Primitive : std::uint8_t {
  boolean,
  int8,
  uint8,  ///< also `byte` and `char`
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  string,
  wstring,
  structure  ///< another message
};

/// "float64"; "message" for a structure.
[[nodiscard]] const char* name_of(Primitive primitive);
/// The size in CDR of a number or bool in bytes, which is also its alignment. Strings and structures: 0.
[[nodiscard]] std::size_t size_of(Primitive primitive);

/// A constant or default value of one element.
using Literal = std::variant<bool, std::int64_t, std::uint64_t, double, std::string>;

struct Structure;

struct Type {
  enum class Repeat : std::uint8_t { once, array, sequence };
  Primitive primitive = Primitive::boolean;
  std::uint32_t string_bound = 0;  ///< 0: none
  Repeat repeat = Repeat::once;
  std::uint32_t count = 0;  ///< array: number of elements; sequence: largest number, 0: no bound
  std::string refers{};     ///< for a structure: "geometry_msgs/msg/Vector3"
  std::shared_ptr<const Structure> structure{};  ///< for a structure, once it is resolved

  /// As definitions write it: "float64[36]", "geometry_msgs/Vector3".
  [[nodiscard]] std::string text() const;
};

struct Field {
  std::string name;
  Type type;
  std::vector<Literal> defaults{};  ///< empty: none; one, or the elements of an array or sequence
  bool has_default = false;
};

struct Constant {
  std::string name;
  Primitive primitive = Primitive::boolean;
  Literal value;
};

/// A message, or one half of a service.
struct Structure {
  std::string name;  ///< "geometry_msgs/msg/Twist"
  std::vector<Field> fields{};
  std::vector<Constant> constants{};
  std::string text{};  ///< the definition without comments and empty lines

  /// nullptr: no field has that name.
  [[nodiscard]] const Field* find(const std::string& field) const;
};

}  // namespace tessera::ros2
