#include <fmt/core.h>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "diagnostics/source.hpp"
#include "project/files/assets.hpp"
#include "project/files/ros2_messages.hpp"
#include "project/files/world_check.hpp"
#include "project/verification/measured_times.hpp"
#include "project/verification/pipeline.hpp"
#include "spec/model/former_routes.hpp"
#include "spec/parser.hpp"
#include "timing/declared.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct CheckOptions {
  std::string spec = ".", json;
};

// "1 agent", "3 subsystems"
template <class Things>
std::string count_of(const Things& things, const char* name) {
  return fmt::format("{} {}{}", things.size(), name, things.size() == 1 ? "" : "s");
}

int check_json(const CheckOptions& options) {
  diagnostics::Diagnostics found = diagnostics::load(spec_file(options.spec));
  if (!found.has_errors())
    if (std::optional<spec::Model> model = spec::parse(found)) {
      const auto project = std::filesystem::absolute(spec_file(options.spec)).parent_path();
      find_messages(*model, project, found);
      read_measured_times(*model, project, found);
      if (check_simulation_files(*model, project, found)) check_world(*model, project, "", found);
      if (judge_models(*model, found)) static_cast<void>(build(*model, found));
      note_former_routes(*model, found);
      timing::note_missing(*model, found);
    }
  write_output(options.json, diagnostics::render_json(found) + "\n");
  if (!found.has_errors()) return ok;
  return is_unreadable(found) ? usage : failed;
}

int check_command(const CheckOptions& options) {
  if (!options.json.empty()) return check_json(options);
  std::optional<Specification> specification = read(options.spec, terminal());
  if (!specification) return exit_code_without_net();
  const bool sound = models_are_sound(*specification, terminal());
  if (!simulation_is_possible(*specification, terminal()) || !sound) return exit_code_without_net();
  const std::optional<Nets> nets = build(*specification, terminal());
  if (!nets) return failed;
  diagnostics::Diagnostics notes = specification->diagnostics.of_same_source();
  note_former_routes(specification->model, notes);
  timing::note_missing(specification->model, notes);
  terminal().say(notes);
  const spec::Model& model = specification->model;
  fmt::print("{}: {}, {}, {}; {}, {}\n", model.system, count_of(model.agents, "agent"),
             count_of(model.instances, "subsystem"), count_of(model.channels, "channel"),
             count_of(nets->flat.places(), "place"), count_of(nets->flat.transitions(), "transition"));
  return ok;
}

}  // namespace

void add_check(CommandLine& app) {
  Subcommand command = app.add("check", "Read a specification and report every mistake in it");
  CheckOptions& options = command.runs(check_command);
  declare_specification(command, options.spec);
  command.option("--json", options.json, "Write the diagnostics as JSON (- is standard output)");
  command.footer(
      "Ends with 0 if the specification is right, 1 if it is wrong, 2 if it cannot be read.\n"
      "Example: tessera check robot/spec.yaml");
}

}  // namespace tessera::cli
