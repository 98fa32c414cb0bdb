#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

/// A kind of driver of real buffers.
struct DriverKind {
  enum class Values : std::uint8_t {
    any,      ///< the C++ class decides
    number,   ///< one float32 or float64
    numbers,  ///< any number of them, in arrays and structures
    flag,     ///< one bool
    colours,  ///< uint8 numbers
    depths,   ///< float32 numbers
    labels    ///< uint16 numbers
  };
  std::string_view name;
  bool receptors, effectors;
  bool simulated_only;  ///< a part of the simulated world
  bool lists;           ///< may have a list of targets
  std::string_view target;
  Values values;

  /// A device of the real robot that needs no C++ class: a topic of ROS 2.
  [[nodiscard]] bool is_topic() const { return name == "ros2"; }
  /// Controls that an operator moves.
  [[nodiscard]] bool is_panel() const { return name == "panel"; }
};

/// nullptr: there is none of that name.
[[nodiscard]] const DriverKind* find_kind(std::string_view name);
[[nodiscard]] std::vector<std::string> kind_names();

/// Whether values of that type can be those of the kind. The world itself knows how many numbers it needs.
[[nodiscard]] bool has_values_of(const DriverKind& kind, const Type& type, const Model& model);
/// "a real buffer of type float64 or float32"
[[nodiscard]] std::string_view description_of(DriverKind::Values values);

}  // namespace tessera::spec
