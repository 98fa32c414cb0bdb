#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/outputs.hpp"
#include "cli/terminal.hpp"
#include "cli/world_drivers.hpp"
#include "project/files/chosen_world.hpp"
#include "project/files/installation.hpp"
#include "project/files/world_check.hpp"
#include "project/verification/pipeline.hpp"
#include "tessera/printable.hpp"

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

/// "gyro  sensor  float64[3]", and the remaining facts.
std::string line_of(const Json& entry) {
  std::string more;
  if (entry.contains("joint")) more += "  " + text_in(entry, "joint");
  if (entry.contains("range"))
    more += fmt::format("  {} .. {}", entry["range"][0].get<double>(), entry["range"][1].get<double>());
  if (entry.contains("picture"))
    more += fmt::format("  width: {}, height: {}", entry["picture"][0].get<int>(),
                        entry["picture"][1].get<int>());
  if (entry.contains("velocity_type")) more += "  joint_velocity " + text_in(entry, "velocity_type");
  if (entry.contains("label")) more += fmt::format("  label {}", entry["label"].get<int>());
  if (const std::string by = text_in(entry, "moved_by"); !by.empty()) more += "  " + by + " float64[7]";
  return fmt::format("  {:<24} {:<15} {:<11}{}", text_in(entry, "name"), text_in(entry, "kind"),
                     text_in(entry, "type"), more);
}

void print_groups(const Json& contents) {
  for (const Group& group : groups) {
    if (contents[group.list].empty()) continue;
    fmt::print("{}\n", group.title);
    for (const Json& entry : contents[group.list]) {
      std::string line = line_of(entry);
      line.erase(line.find_last_not_of(' ') + 1);
      fmt::print("{}\n", printable(line));  // names may have any characters
    }
  }
  for (const auto& [what, count] : contents["nameless"].items())
    fmt::print("{} without a name, which no driver can use: {}\n", what, count.get<int>());
}

struct AskedWorld {
  ChosenWorld world;
  std::vector<WorldAgent> agents;
};

/// The world of a specification, or the file itself if it is one.
std::optional<AskedWorld> world_named(const std::string& file) {
  if (file.ends_with(".xml") || file.ends_with(".mjb")) {
    const auto found = find_asset(file, std::filesystem::current_path(), "worlds");
    if (!found) return complain(fmt::format("there is no world {}", file)), std::nullopt;
    return AskedWorld{world_in(*found), {}};
  }
  const std::optional<Specification> specification = read(file, terminal());
  if (!specification) return std::nullopt;
  const auto& simulation = specification->model.simulation;
  if (!simulation || !simulation->has_world())
    return complain("the specification names no world under `simulation`"), std::nullopt;
  auto world = project::world_of(*simulation, specification->project);
  if (!world) return complain(fmt::format("there is no world {}", simulation->world)), std::nullopt;
  AskedWorld asked{std::move(*world), {}};
  for (const spec::Agent& agent : specification->model.agents)
    asked.agents.push_back({agent.path, agent.fleet.valid()});
  return asked;
}

int world_command(const WorldCommandOptions& options) {
  const std::optional<AskedWorld> asked = world_named(options.file);
  if (!asked) return failed;
  const auto contents = contents_of_world(asked->world);
  if (!contents) return complain(contents.problem());
  if (!options.json.empty()) {
    write_output(options.json, *contents + "\n");
    return ok;
  }
  const Json json = Json::parse(*contents);
  fmt::print("{}: steps of {} s\n", asked->world.name, json["timestep_s"].get<double>());
  print_groups(json);
  if (const std::string drivers = drivers_section(json, asked->agents); !drivers.empty())
    fmt::print("\n{}", drivers);
  return ok;
}

}  // namespace

void add_world(CommandLine& app) {
  Subcommand command = app.add("world", "List what a simulated world offers, with drivers for it");
  WorldCommandOptions& options = command.runs(world_command);
  command.option("file", options.file, "A MuJoCo model (XML), or a specification that names one")
      .shows_default();
  command.option("--json", options.json, "Write the list as JSON (- is standard output)");
  command.footer(
      "Examples:\n  tessera world arm.xml\n  tessera world          the world of ./spec.yaml\n"
      "The kinds of drivers are described in docs/use/worlds.md.");
}

}  // namespace tessera::cli
