#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tessera::spec {

/// The control with which an operator gives one field of a real buffer its value.
struct PanelControl {
  enum class Kind : std::uint8_t {
    button,       ///< true while it is held
    switch_over,  ///< true until it is switched back
    slider,       ///< stays where it is
    stick_x,      ///< to the right is more; springs back to zero
    stick_y       ///< up is more; springs back to zero
  } kind = Kind::button;
  std::string field{};              ///< "forward", "arm.grip"; "value" if the buffer is no structure
  std::string unit{};               ///< of the field's type; empty: none
  bool whole = false;               ///< the field is an integer
  double minimum = 0, maximum = 1;  ///< of a number

  [[nodiscard]] bool is_number() const { return kind >= Kind::slider; }
};

/// As the specification writes it: "stick_x".
[[nodiscard]] std::string_view name_of(PanelControl::Kind kind);

/// An input of the script of a simulated run. The value stays until the script changes it.
struct PanelStep {
  std::chrono::nanoseconds at;  ///< from the start of the run
  std::string field;            ///< of a control
  std::variant<double, bool> value;

  bool operator==(const PanelStep&) const = default;
};

/// The controls behind a real buffer of a receptor. Fields without a control stay zero.
struct Panel {
  std::vector<PanelControl> controls;
  std::chrono::nanoseconds stale = std::chrono::milliseconds(500);  ///< an input counts for so long
  std::vector<PanelStep>
      script;  ///< simulation only, in the order of its times; empty: an operator gives inputs
};

}  // namespace tessera::spec
