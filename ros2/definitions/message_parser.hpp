#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ros2/definitions/type.hpp"
#include "tessera/nearest.hpp"

namespace tessera::ros2 {

/// A mistake in a definition, or in its name.
struct Mistake {
  std::string file;      ///< empty: the mistake is in no file
  std::size_t line = 0;  ///< from 1; 0: the whole file
  std::string text;
  Hint hint{};

  /// "Twist.msg:3: unknown type 'flaot64'; did you mean 'float64'?"
  [[nodiscard]] std::string shown() const;
};

/// Reads a .msg file. Types of other messages get their full names and are not looked up.
///
/// name: "geometry_msgs/msg/Twist". file: for mistakes. All mistakes are reported, then nullopt.
/// Threads: pure.
[[nodiscard]] std::optional<Structure> parse_message(std::string_view name, std::string_view text,
                                                     std::string_view file, std::vector<Mistake>& mistakes);

struct Service {
  Structure request, response;  ///< "example_interfaces/srv/AddTwoInts_Request", "..._Response"
};
/// Reads a .srv file: request, a line of three dashes, response.
[[nodiscard]] std::optional<Service> parse_service(std::string_view name, std::string_view text,
                                                   std::string_view file, std::vector<Mistake>& mistakes);

struct Action {
  Structure goal, result, feedback;  ///< "nav2_msgs/action/NavigateToPose_Goal", "..._Result", "..._Feedback"
};
/// Reads a .action file: goal, result and feedback, with lines of three dashes between them.
[[nodiscard]] std::optional<Action> parse_action(std::string_view name, std::string_view text,
                                                 std::string_view file, std::vector<Mistake>& mistakes);

}  // namespace tessera::ros2
