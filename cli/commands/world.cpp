#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/outputs.hpp"
#include "cli/terminal.hpp"
#include "project/files/chosen_world.hpp"
#include "project/files/installation.hpp"
#include "project/files/world_check.hpp"
#include "project/verification/pipeline.hpp"

namespace tessera::cli {

using namespace project;

namespace {

using Json = nlohmann::ordered_json;

struct WorldCommandOptions {
  std::string file = ".", json;
};

struct Group {
  const char *list, *title;
};
constexpr Group groups[] = {{"sensors", "Sensors"}, {"joints", "Joints"},         {"actuators", "Actuators"},
                            {"sites", "Sites"},     {"cameras", "Cameras"},       {"bodies", "Bodies"},
                            {"geoms", "Geoms"},     {"equalities", "Equalities"}, {"keyframes", "Keyframes"}};

std::string text_of(const Json& entry, const char* key) { return entry.value(key, std::string()); }

/// ", width: 64, height: 48": of a camera.
std::string picture_of(const Json& entry) {
  const Json& size = entry["picture"];
  return fmt::format(", width: {}, height: {}", size[0].get<int>(), size[1].get<int>());
}

/// "gyro  sensor  float64[3]", and what else there is to say.
std::string line_of(const Json& entry) {
  std::string more;
  if (entry.contains("joint")) more += "  " + text_of(entry, "joint");
  if (entry.contains("range"))
    more += fmt::format("  {} .. {}", entry["range"][0].get<double>(), entry["range"][1].get<double>());
  if (entry.contains("picture")) more += " " + picture_of(entry).substr(1);
  if (entry.contains("velocity_type")) more += "  joint_velocity " + text_of(entry, "velocity_type");
  if (entry.contains("label")) more += fmt::format("  label {}", entry["label"].get<int>());
  if (const std::string by = text_of(entry, "moved_by"); !by.empty()) more += "  " + by + " float64[7]";
  return fmt::format("  {:<24} {:<15} {:<11}{}", text_of(entry, "name"), text_of(entry, "kind"),
                     text_of(entry, "type"), more);
}

void print_groups(const Json& contents) {
  for (const Group& group : groups) {
    if (contents[group.list].empty()) continue;
    fmt::print("{}\n", group.title);
    for (const Json& entry : contents[group.list]) {
      std::string line = line_of(entry);
      line.erase(line.find_last_not_of(' ') + 1);
      fmt::print("{}\n", line);
    }
  }
  for (const auto& [what, count] : contents["nameless"].items())
    fmt::print("{} without a name, which no driver can use: {}\n", what, count.get<int>());
}

/// A name of the world as the name of a buffer: letters, digits, single underscores.
std::string buffer_name(const std::string& name, std::set<std::string>& taken) {
  std::string made;
  for (const char c : name) {
    const bool good = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (good || (!made.empty() && made.back() != '_')) made += good ? c : '_';
  }
  while (made.ends_with('_')) made.pop_back();
  if (made.empty() || std::isdigit(static_cast<unsigned char>(made[0])) != 0) made = "n" + made;
  std::string unique = made;
  for (int number = 2; !taken.insert(unique).second; ++number) unique = made + std::to_string(number);
  return unique;
}

/// Quoted where YAML would read it in another way.
std::string yaml_text(const std::string& text) {
  const bool plain = !text.empty() && std::ranges::all_of(text, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/' || c == '-' || c == '.';
  }) && std::isalpha(static_cast<unsigned char>(text[0])) != 0;
  return plain ? text : Json(text).dump();
}

/// One subsystem's lines: its buffers, and drivers for them.
struct Section {
  std::string subsystem;
  std::string buffers, drivers;
  std::set<std::string> taken;

  /// options: after the target, such as ", width: 64".
  void add(const Json& entry, const std::string& kind, const std::string& type,
           const std::string& options = {}) {
    const std::string name = text_of(entry, "name"), buffer = buffer_name(name, taken);
    buffers += fmt::format("#     {}: {}\n", buffer, type);
    drivers += fmt::format("    robot.{}.{}: {{ {}: {}{} }}  # {}\n", subsystem, buffer, kind,
                           yaml_text(name), options, type);
  }
};

/// A ready section `drivers` with a buffer for every sensor, camera, joint and actuator.
std::string drivers_section(const Json& contents) {
  Section sensors{"sensors", "", "", {}}, joints{"joints", "", "", {}}, motors{"motors", "", "", {}},
      cameras{"cameras", "", "", {}};
  for (const Json& entry : contents["sensors"])
    if (!text_of(entry, "kind").empty()) sensors.add(entry, "sensor", text_of(entry, "type"));
  for (const Json& entry : contents["cameras"])
    cameras.add(entry, "camera", text_of(entry, "type"), picture_of(entry));
  for (const Json& entry : contents["joints"]) joints.add(entry, "joint_position", text_of(entry, "type"));
  for (const Json& entry : contents["actuators"]) motors.add(entry, "actuator", text_of(entry, "type"));
  std::string drivers, buffers;
  for (const Section* section : {&sensors, &cameras, &joints, &motors}) {
    if (section->drivers.empty()) continue;
    drivers += section->drivers;
    buffers += fmt::format("#   {}, real:\n{}", section->subsystem, section->buffers);
  }
  if (drivers.empty()) return "";
  return "simulation:\n  drivers:\n" + drivers + "# Real buffers of the subsystems that they serve:\n" +
         buffers;
}

/// The world of a specification, or the file itself if it is one.
std::optional<ChosenWorld> world_named(const std::string& file) {
  if (file.ends_with(".xml") || file.ends_with(".mjb")) {
    const auto found = find_asset(file, std::filesystem::current_path(), "worlds");
    if (!found) return complain(fmt::format("there is no world {}", file)), std::nullopt;
    return world_in(*found);
  }
  const std::optional<Specification> specification = read(file, terminal());
  if (!specification) return std::nullopt;
  const auto& simulation = specification->model.simulation;
  if (!simulation || !simulation->has_world())
    return complain("the specification names no world under `simulation`"), std::nullopt;
  auto world = project::world_of(*simulation, specification->project);
  if (!world) complain(fmt::format("there is no world {}", simulation->world));
  return world;
}

int world_command(const WorldCommandOptions& options) {
  const std::optional<ChosenWorld> world = world_named(options.file);
  if (!world) return failed;
  const auto contents = contents_of_world(*world);
  if (!contents) return complain(contents.problem());
  if (!options.json.empty()) {
    write_output(options.json, *contents + "\n");
    return ok;
  }
  const Json json = Json::parse(*contents);
  fmt::print("{}: steps of {} s\n", world->name, json["timestep_s"].get<double>());
  print_groups(json);
  if (const std::string drivers = drivers_section(json); !drivers.empty()) fmt::print("\n{}", drivers);
  return ok;
}

}  // namespace

void add_world(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("world", "List what a simulated world offers, with drivers for it");
  auto options = std::make_shared<WorldCommandOptions>();
  command.option("file", options->file, "A MuJoCo model (XML), or a specification that names one")
      .shows_default();
  command.option("--json", options->json, "Write the list as JSON (- is standard output)");
  command.footer(
      "Examples:\n  tessera world arm.xml\n  tessera world          the world of ./spec.yaml\n"
      "The kinds of drivers are described in docs/worlds.md.");
  command.callback([options, &exit_code] { exit_code = world_command(*options); });
}

}  // namespace tessera::cli
