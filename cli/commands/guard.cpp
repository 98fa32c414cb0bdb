#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "project/files/file_names.hpp"
#include "project/files/installation.hpp"
#include "project/files/state_folder.hpp"
#include "project/files/trust.hpp"
#include "tessera/given_values.hpp"

namespace tessera::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* example = "examples/14_guard";

struct GuardOptions {
  std::string from, to;
  std::string stale = "200ms", most = "0.5,1.0", interface = "lo", duration;
  int domain = -1;
  bool stamped = false;
};

/// Refuses what would be another topic, or no text of a specification.
std::optional<std::string> problem_of(const GuardOptions& options) {
  static const std::regex topic("/[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*");
  for (const std::string& name : {options.from, options.to})
    if (!std::regex_match(name, topic))
      return fmt::format("'{}' is no whole name of a topic: /cmd_vel, or /robot/cmd_vel", name);
  if (options.from == options.to) return "the guard cannot listen to the topic on which it publishes";
  if (!std::regex_match(options.interface, std::regex("[A-Za-z0-9_.:@-]+")))
    return fmt::format("'{}' is no network interface", options.interface);
  if (!std::regex_match(options.most, std::regex("[0-9]+(\\.[0-9]+)?,[0-9]+(\\.[0-9]+)?")))
    return fmt::format("--max {}: expected LINEAR,ANGULAR in m/s and rad/s, such as 0.5,1.0", options.most);
  if (!parse_duration(options.stale))
    return fmt::format("--stale {}: expected a time such as 200ms", options.stale);
  return std::nullopt;
}

/// The drivers of the guard, as the last part of its specification.
std::string drivers_of(const GuardOptions& options) {
  const std::string within = options.stamped ? "twist." : "";
  std::string ends = fmt::format("    interface: {}\n", options.interface);
  if (options.domain >= 0) ends += fmt::format("    domain: {}\n", options.domain);
  const auto driver = [&](const char* buffer, const std::string& topic) {
    return fmt::format(
               "  {}:\n    ros2: {}\n    type: geometry_msgs/msg/{}\n    fields: {{ {}linear.x: x, "
               "{}linear.y: y, "
               "{}linear.z: z, {}angular.x: roll, {}angular.y: pitch, {}angular.z: yaw }}\n",
               buffer, topic, options.stamped ? "TwistStamped" : "Twist", within, within, within, within,
               within, within) +
           ends;
  };
  return "drivers:\n" + driver("guard.ears.wish", options.from) + "    publishers: one\n" +
         driver("guard.base.command", options.to);
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return text;
}

/// A file that has not changed keeps its time, so that nothing is compiled again.
void keep(const fs::path& file, const std::string& text) {
  if (project::is_kept_by_user(file) && bytes_of(file) == text) return;
  fs::create_directories(file.parent_path());
  project::keep_for_user(file, text);
}

/// Makes the project of this guard, and returns its folder: one for each pair of topics, so that two guards can run.
fs::path project_of(const GuardOptions& options) {
  const std::optional<fs::path> kept = project::user_folder();
  if (!kept) throw std::runtime_error("there is no folder for the guard: set HOME or TESSERA_STATE_DIR");
  std::string name = options.from + "-" + options.to + "-" + options.interface;
  std::ranges::replace(name, '/', '.');
  const fs::path folder = *kept / "guard" / name.substr(1);
  const fs::path from = project::Installation::find().share / example;
  std::string specification = bytes_of(from / project::file_names::specification);
  specification.erase(specification.find("\ndrivers:\n") + 1);
  keep(folder / project::file_names::specification, specification + drivers_of(options));
  for (const char* const source : {"src/guard/control.cpp", "src/guard/devices.cpp"})
    keep(folder / source, bytes_of(from / source));
  static_cast<void>(project::trust(folder));
  return folder;
}

int guard_command(GuardOptions options) {
  if (const auto problem = problem_of(options)) return complain(*problem), usage;
  const std::size_t comma = options.most.find(',');
  const fs::path folder = project_of(options);
  fmt::print("{} -> {}: commands that are older than {}, or faster than {} m/s or {} rad/s, stop the base\n",
             options.from, options.to, options.stale, options.most.substr(0, comma),
             options.most.substr(comma + 1));
  return run_project(folder,
                     {"stale=" + options.stale, "max_linear=" + options.most.substr(0, comma),
                      "max_angular=" + options.most.substr(comma + 1)},
                     options.duration);
}

}  // namespace

void add_guard(CommandLine& app) {
  Subcommand command = app.add(
      "guard", "Stand between any publisher of velocities of ROS 2 and any base, and stop it when in doubt");
  GuardOptions& options = command.runs(guard_command);
  command.option("from", options.from, "Topic to listen to: /cmd_vel_in").required();
  command.option("to", options.to, "Topic of the base: /cmd_vel").required();
  command.option("--stale", options.stale, "An older command stops the base").shows_default();
  command.option("--max", options.most, "LINEAR,ANGULAR in m/s and rad/s: a faster command stops the base")
      .shows_default();
  command.flag("--stamped", options.stamped, "The commands are TwistStamped");
  command.option("--interface", options.interface, "Network interface").shows_default();
  command.option("--domain", options.domain, "Domain of DDS (default: that of ROS_DOMAIN_ID, or 0)")
      .within(0, 232);
  command.option("--for", options.duration, "End after this time: 60s (default: until Ctrl-C)");
  command.footer(
      "Example:\n  tessera guard /cmd_vel_in /cmd_vel --stale 200ms --max 0.5,1.0\n"
      "Its project is examples/14_guard; docs/use/ros2_nodes.md#a-guard-for-any-base says what it promises.");
}

}  // namespace tessera::cli
