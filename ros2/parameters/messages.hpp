#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ros2/codec/translator.hpp"
#include "ros2/parameters/values.hpp"

/// The messages of the services of parameters, /parameter_events and /diagnostics, with encapsulation and without the
/// header of a request. Functions that read take any bytes; nullopt: they are no such message.
namespace tessera::ros2 {

using NamedValue = std::pair<std::string, ParameterValue>;

/// The request of GetParameters, GetParameterTypes and DescribeParameters.
[[nodiscard]] std::optional<std::vector<std::string>> read_names(std::span<const std::byte> message);
struct ListRequest {
  std::vector<std::string> prefixes{};  ///< empty: all
  std::uint64_t depth = 0;              ///< of names below a prefix; 0: any
};
[[nodiscard]] std::optional<ListRequest> read_list_request(std::span<const std::byte> message);
/// The request of SetParameters and SetParametersAtomically.
[[nodiscard]] std::optional<std::vector<NamedValue>> read_set_request(std::span<const std::byte> message);

[[nodiscard]] std::vector<std::byte> list_answer(std::span<const std::string> names,
                                                 std::span<const std::string> prefixes);
[[nodiscard]] std::vector<std::byte> values_answer(std::span<const ParameterValue> values);
[[nodiscard]] std::vector<std::byte> types_answer(std::span<const ParameterValue> values);
/// A name, and its parameter; nullptr: there is none.
using Described = std::pair<std::string, const Ros2Parameter*>;
[[nodiscard]] std::vector<std::byte> descriptors_answer(std::span<const Described> parameters);
/// Reasons for a refusal; nullopt: it was set.
using SetOutcome = std::optional<std::string>;
[[nodiscard]] std::vector<std::byte> set_answer(std::span<const SetOutcome> outcomes);
[[nodiscard]] std::vector<std::byte> set_all_answer(const SetOutcome& outcome);

/// rcl_interfaces/msg/ParameterEvent; node: its full name.
struct ParameterEvent {
  Stamp stamp{};
  std::string node{};
  std::vector<NamedValue> made{}, changed{};
};
[[nodiscard]] std::vector<std::byte> event_message(const ParameterEvent& event);

/// diagnostic_msgs/msg/DiagnosticArray. hardware: the `hardware_id` of all of them. A status is named after its path
/// behind the name of the node.
[[nodiscard]] std::vector<std::byte> diagnostics_message(const Stamp& stamp, const std::string& node,
                                                         const std::string& hardware,
                                                         std::span<const Ros2Status> statuses);

}  // namespace tessera::ros2
