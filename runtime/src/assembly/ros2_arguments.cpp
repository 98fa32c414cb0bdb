#include "assembly/ros2_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <memory>
#include <string_view>
#include <utility>
#include <variant>

#include "drivers/devices.hpp"
#include "drivers/ros2_library.hpp"
#include "parameters/parameter_changes.hpp"
#include "parameters/ros2_parameters.hpp"
#include "tessera/driver_setup.hpp"
#include "tessera/ros2_arguments.hpp"

namespace tessera {
namespace {

constexpr std::string_view topic_class = "ros2";  // as the generator calls the drivers of topics

std::string text_option(const CppDriver& driver, std::string_view name) {
  const auto found = std::ranges::find(driver.options, name, &DriverOption::name);
  if (found == driver.options.end()) return {};
  const auto* const text = std::get_if<std::string_view>(&found->value);
  return text == nullptr ? std::string() : std::string(*text);
}

std::vector<Ros2Use> uses_of(const System& system) {
  std::vector<Ros2Use> uses;
  for (const CppDriver& driver : system.real_drivers)
    if (driver.class_name == topic_class && is_of(system, driver) && !text_option(driver, "topic").empty())
      uses.push_back({.path = std::string(driver.path),
                      .topic = text_option(driver, "topic"),
                      .type = text_option(driver, "type"),
                      .role = text_option(driver, "role"),
                      .node = text_option(driver, "node")});
  return uses;
}

/// The subsystems are made for this alone.
std::vector<Ros2Parameter> parameters_of(const System& system) {
  std::vector<std::pair<std::unique_ptr<Subsystem>, std::unique_ptr<Bindings>>> copies;
  std::vector<ParameterOwner> owners;
  for (const Instance& instance : system.instances) {
    copies.emplace_back(instance.make(), std::make_unique<Bindings>());
    copies.back().first->bind(*copies.back().second);
    owners.push_back({fmt::format("{}.{}", instance.agent, instance.name), copies.back().second->parameters});
  }
  const ParameterChanges values(std::move(owners));
  return ros2_parameters(values.owners(), values.offered());
}

}  // namespace

bool take_ros2_arguments(const ProcessPart& part, RunOptions& options, Ros2ArgumentNotes& notes,
                         std::string& error) try {
  if (!options.ros2_arguments) return true;
  Ros2Arguments arguments{.words = *options.ros2_arguments,
                          .uses = uses_of(part.system),
                          .parameters = parameters_of(part.system)};
  const auto read = reinterpret_cast<Ros2ArgumentsReader>(
      ros2_function({TESSERA_ROS2_BUILT, TESSERA_ROS2_INSTALLED}, ros2_arguments_function));
  if (!read(arguments, error)) return false;
  std::ranges::move(arguments.values, std::back_inserter(options.parameters));
  notes = {std::move(arguments.notes), std::move(arguments.warnings)};
  return true;
} catch (const std::exception& problem) {  // constructors of user code; the library
  error = fmt::format("--ros-args: {}", problem.what());
  return false;
}

}  // namespace tessera
