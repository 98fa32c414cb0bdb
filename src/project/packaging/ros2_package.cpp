#include "project/packaging/ros2_package.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "project/files/file_names.hpp"
#include "project/files/files.hpp"
#include "ros2/naming/names.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

constexpr const char* project_options = "project.cmake";

bool is_small_letter(char c) { return c >= 'a' && c <= 'z'; }
bool is_name_digit(char c) { return c >= '0' && c <= '9'; }

/// "1.0" is "1.0.0"; nullopt: no numbers with points.
std::optional<std::string> version_of(std::string_view text) {
  std::array<unsigned, 3> numbers{};
  for (std::size_t part = 0;; ++part) {
    if (part == numbers.size()) return std::nullopt;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), numbers[part]);
    if (problem != std::errc{}) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) return fmt::format("{}.{}.{}", numbers[0], numbers[1], numbers[2]);
    if (!text.starts_with('.')) return std::nullopt;
    text.remove_prefix(1);
  }
}

std::string package_xml(const std::string& name, const std::string& version, const std::string& system) {
  return fmt::format(R"(<?xml version="1.0"?>
<?xml-model href="http://download.ros.org/schema/package_format3.xsd" schematypens="http://www.w3.org/2001/XMLSchema"?>
<package format="3">
  <name>{}</name>
  <version>{}</version>
  <description>The controller of {}, made by Tessera.</description>
  <maintainer email="nobody@example.com">nobody</maintainer>
  <license>TODO: License declaration</license>

  <buildtool_depend>ament_cmake</buildtool_depend>

  <exec_depend>launch</exec_depend>
  <exec_depend>launch_ros</exec_depend>

  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
)",
                     name, version, system);
}

std::string cmake_lists(const std::string& name, const std::string& spec, bool has_options) {
  return fmt::format(
      R"(# Builds the controller, with colcon or with CMake alone. Tessera verifies the specification when CMake configures.
cmake_minimum_required(VERSION 3.25)
project({} LANGUAGES CXX)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_package(ament_cmake QUIET)  # of ROS 2; not needed to build
find_package(tessera REQUIRED)
{}
tessera_add_controller(controller SPEC {}{})

install(TARGETS controller DESTINATION lib/${{PROJECT_NAME}})
install(DIRECTORY launch config DESTINATION share/${{PROJECT_NAME}})
if(ament_cmake_FOUND)
  ament_package()
else()
  install(FILES package.xml DESTINATION share/${{PROJECT_NAME}})
endif()
)",
      name,
      has_options
          ? fmt::format("\n# The libraries and flags of the project.\nadd_library(project INTERFACE)\n"
                        "set(TESSERA_PROJECT_DIR \"${{CMAKE_CURRENT_SOURCE_DIR}}\")\n"
                        "include({})\n",
                        project_options)
          : "",
      spec, has_options ? " LIBRARIES project" : "");
}

std::string launch_file(const std::string& name) {
  return fmt::format(R"(# Starts the controller, which moves the robot:
#   ros2 launch {0} {0}.launch.py namespace:=/left remappings:="/cmd_vel:=/base/cmd_vel /scan:=/front"
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def controller(context):
    def given(argument):
        return LaunchConfiguration(argument).perform(context)

    names = []
    for rule in given("remappings").split():
        if ":=" not in rule:
            raise RuntimeError("remappings: '" + rule + "' is no FROM:=TO")
        names += ["-r", rule]
    if given("namespace"):
        names += ["-r", "__ns:=/" + given("namespace").strip("/")]
    if given("params_file"):
        names += ["--params-file", given("params_file")]
    return [
        Node(
            package="{0}",
            executable="controller",
            arguments=["run"] + given("arguments").split(),
            ros_arguments=names,
            output="screen",
        )
    ]


def generate_launch_description():
    share = get_package_share_directory("{0}")
    return LaunchDescription(
        [
            DeclareLaunchArgument("namespace", default_value="", description="of all nodes, such as /left"),
            DeclareLaunchArgument(
                "params_file", default_value=share + "/config/params.yaml", description="YAML, or empty for none"
            ),
            DeclareLaunchArgument("remappings", default_value="", description="FROM:=TO, with blanks between"),
            DeclareLaunchArgument("arguments", default_value="", description="for the controller: --for 60s"),
            OpaqueFunction(function=controller),
        ]
    )
)",
                     name);
}

std::string node_of(const spec::Model& model, const spec::Driver& driver) {
  const auto node = driver.options.find("node");
  if (node != driver.options.end())
    if (const auto* const text = std::get_if<std::string>(&node->second.value)) return *text;
  const std::string path = model.driver_path(driver);
  return ros2::node_name_of(path.substr(0, path.find('.')));
}

/// The nodes of the system and the agents of each.
std::map<std::string, std::set<std::string>> nodes_of(const spec::Model& model) {
  std::map<std::string, std::set<std::string>> nodes;
  for (const spec::Driver& driver : model.drivers) {
    const std::string path = model.driver_path(driver);
    if (driver.kind == "ros2") nodes[node_of(model, driver)].insert(path.substr(0, path.find('.')));
  }
  return nodes;
}

bool is_real(const spec::Type& type) {
  return type.kind == spec::Type::Kind::scalar &&
         (type.scalar == Scalar::float32 || type.scalar == Scalar::float64);
}

/// A number of C++ as YAML has it, with its point if it is one of `float64`; nullopt: ROS 2 has no such number.
std::optional<std::string> number_in_yaml(const spec::Type& type, std::string text) {
  while (!text.empty() && std::string_view("uUlLfF").find(text.back()) != std::string_view::npos)
    text.pop_back();
  if (is_real(type)) {
    double number = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    text = fmt::format("{}", number);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
  }
  std::int64_t number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return std::to_string(number);
}

std::optional<std::string> value_in_yaml(const spec::Type& type, const std::string& initial) {
  if (type.kind == spec::Type::Kind::structure || type.is_sequence) return std::nullopt;
  if (type.extent > 0) {
    if (type.kind == spec::Type::Kind::string) return std::nullopt;
    std::string_view rest = initial;
    std::string text;
    if (rest.size() > 1) rest = rest.substr(1, rest.size() - 2);
    for (std::uint64_t index = 0; index < type.extent; ++index) {
      const std::size_t end = std::min(rest.find(", "), rest.size());
      const auto one = value_in_yaml(type.element(), std::string(rest.substr(0, end)));
      if (!one) return std::nullopt;
      text += (index == 0 ? "" : ", ") + *one;
      rest.remove_prefix(std::min(end + 2, rest.size()));
    }
    return "[" + text + "]";
  }
  if (type.kind == spec::Type::Kind::string) {
    if (initial.empty()) return "\"\"";
    // These characters behind a backslash mean the same in C++ and in YAML.
    for (std::size_t at = initial.find('\\'); at != std::string::npos; at = initial.find('\\', at + 2))
      if (std::string_view("nt\"\\").find(initial[at + 1]) == std::string_view::npos) return std::nullopt;
    return initial;
  }
  if (type.scalar == Scalar::boolean) return initial.empty() ? "false" : initial;
  return number_in_yaml(type, initial.empty() ? "0" : initial);
}

std::string comment_of(const spec::Parameter& parameter) {
  std::string text = parameter.type.unit;
  if (parameter.minimum || parameter.maximum)
    text += fmt::format("{}{} to {}", text.empty() ? "" : ", ",
                        parameter.minimum ? fmt::format("{}", *parameter.minimum) : "any",
                        parameter.maximum ? fmt::format("{}", *parameter.maximum) : "any");
  return text.empty() ? "" : "  # " + text;
}

/// The parameters of one subsystem with their names in the node.
std::string parameters_in_yaml(const spec::Model& model, spec::InstanceId instance,
                               const std::string& prefix) {
  std::string text;
  const std::vector<spec::Parameter>& own = model.subsystem(instance).parameters;
  const auto add = [&](const spec::Parameter& one) {
    const auto value = value_in_yaml(one.type, one.initial);
    text += value ? fmt::format("    {}.{}: {}{}\n", prefix, one.name, *value, comment_of(one))
                  : fmt::format("    # {}.{} cannot be given here\n", prefix, one.name);
  };
  for (const spec::Parameter& one : model.parameters)
    if (std::ranges::find(own, one.name, &spec::Parameter::name) == own.end()) add(one);
  for (const spec::Parameter& one : own) add(one);
  return text;
}

std::string parameter_file(const spec::Model& model) {
  std::string text =
      "# The parameters of all nodes, with the values of the specification. In any namespace: /**/NODE.\n"
      "/**:\n  ros__parameters:\n    use_sim_time: false\n";
  for (const auto& [node, agents] : nodes_of(model)) {
    std::string values;
    for (std::uint32_t index = 0; index < model.instances.size(); ++index) {
      const std::string path = model.instance_path({index});
      const std::size_t dot = path.find('.');
      if (!agents.contains(path.substr(0, dot))) continue;
      values += parameters_in_yaml(model, {index}, agents.size() == 1 ? path.substr(dot + 1) : path);
    }
    if (!values.empty()) text += fmt::format("/**/{}:\n  ros__parameters:\n{}", node, values);
  }
  return text;
}

/// Whether a part of the project belongs into a copy: not what was built, and nothing hidden.
bool is_copied(const fs::path& part) {
  static const std::set<std::string> made{"build", "install", "log"};
  const std::string name = part.filename();
  return !name.starts_with('.') && !made.contains(name);
}

void copy_project(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) {
    if (!is_copied(entry.path())) continue;
    const fs::path target = to / entry.path().filename();
    if (entry.is_directory())
      copy_project(entry.path(), target);
    else if (entry.is_regular_file()) {
      fs::create_directories(to);
      copy_whole(entry.path(), target);
    }
  }
}

}  // namespace

std::string ros2_package_name(std::string_view name) {
  std::string made;
  for (const char c : name) {
    const char small = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (is_small_letter(small) || is_name_digit(small))
      made += small;
    else if (!made.empty() && made.back() != '_')
      made += '_';
  }
  while (made.ends_with('_')) made.pop_back();
  if (made.empty() || !is_small_letter(made.front())) made = "robot_" + made;
  return made.size() < 2 ? made + "_robot" : made;
}

Result<std::vector<PackageFile>> ros2_package_files(const Specification& specification,
                                                    const Ros2PackageOptions& options) {
  const spec::Model& model = specification.model;
  const std::string name = options.name.empty() ? model.system : options.name;
  if (const std::string good = ros2_package_name(name); good != name)
    return Problem{
        fmt::format("'{}' is no name of a package of ROS 2, which has small letters, digits and single "
                    "underscores; try --ros2={}",
                    name, good)};
  const auto version = version_of(options.version);
  if (!version)
    return Problem{fmt::format("'{}' is no version of a package of ROS 2; write three numbers, such as 1.2.0",
                               options.version)};
  if (nodes_of(model).empty())
    return Problem{"the system has no driver of ROS 2 (docs/use/ros2.md), so that it would be no node"};
  if (model.deployment)
    return Problem{
        "a system of several processes cannot be a package of ROS 2 yet; `tessera package` makes "
        "packages of Debian for its machines"};
  const bool has_options = fs::exists(specification.project / project_options);
  return std::vector<PackageFile>{
      {"package.xml", package_xml(name, *version, model.system)},
      {"CMakeLists.txt", cmake_lists(name, specification.file.filename(), has_options)},
      {fs::path("launch") / (name + ".launch.py"), launch_file(name)},
      {"config/params.yaml", parameter_file(model)}};
}

Result<fs::path> make_ros2_package(const Specification& specification, const Ros2PackageOptions& options) {
  const Result<std::vector<PackageFile>> files = ros2_package_files(specification, options);
  if (!files) return Problem{files.problem()};
  const std::string name = options.name.empty() ? specification.model.system : options.name;
  const bool copies = !options.folder.empty();
  const fs::path package = copies ? options.folder / name : specification.project;
  if (copies && fs::exists(fs::symlink_status(package)))
    return Problem{fmt::format("{} exists already; remove it, or name another folder", package.string())};
  if (copies && contains(specification.project, package))
    return Problem{
        fmt::format("{} would be a copy of the project inside it; leave --output out to write the "
                    "files into the project",
                    package.string())};
  const fs::path taken = copies ? specification.project : package;
  for (const PackageFile& file : *files)
    if (fs::exists(taken / file.path) && content_of(taken / file.path) != file.text)
      return Problem{
          fmt::format("{} exists already with another text, which is kept; move it away to get the one "
                      "of the package",
                      (taken / file.path).string())};
  if (copies) copy_project(specification.project, package);
  for (const PackageFile& file : *files) write_file(package / file.path, file.text);
  return package;
}

}  // namespace tessera::project
