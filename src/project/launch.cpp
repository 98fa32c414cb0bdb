#include "project/launch.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "project/files/chosen_world.hpp"
#include "project/files/file_names.hpp"
#include "project/files/installation.hpp"
#include "project/files/simulation_file.hpp"
#include "project/verification/verdicts.hpp"
#include "sim/track.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

RunFiles run_files(const LaunchOptions& options) {
  const fs::path folder = fs::absolute(options.folder);
  return {options.record.empty() ? folder / file_names::recording : fs::absolute(options.record),
          folder / file_names::summary};
}

namespace {

fs::path asset(const std::string& name, const fs::path& project, const std::string& folder) {
  std::optional<fs::path> found = find_asset(name, project, folder);
  if (!found)
    throw std::runtime_error(
        fmt::format("there is no {} in {} nor among the shipped {}", name, project.string(), folder));
  return *found;
}

void append(Command& command, std::initializer_list<std::string> words) {
  command.insert(command.end(), words);
}

std::optional<WorldPicture> picture_of(const Specification& specification, const LaunchOptions& options) {
  const spec::Simulation& simulation = *specification.model.simulation;
  if (simulation.world.empty() && options.world.empty()) return std::nullopt;
  WorldPicture picture;
  picture.world = fs::absolute(
      asset(options.world.empty() ? simulation.world : options.world, specification.project, "worlds"));
  if (const std::optional<Floor> floor = floor_of(specification, options)) {
    picture.track = fs::absolute(floor->image);
    picture.metres_per_pixel = floor->metres_per_pixel;
  }
  picture.seed = options.seed;
  return picture;
}

void add_devices(Command& command, const Specification& specification, const LaunchOptions& options) {
  const fs::path file = fs::absolute(options.folder) / file_names::simulation;
  std::ofstream stream(file);
  stream << simulation_json(specification.model, specification.project, picture_of(specification, options))
         << std::flush;
  if (!stream) throw std::runtime_error("cannot write " + file.string());
  append(command, {"--simulation", file.string()});
}

// "robot.motor.left" is in "robot.motor".
bool is_in(std::string_view path, std::string_view name) {
  return path.starts_with(name) && (path.size() == name.size() || path[name.size()] == '.');
}

std::string pose_text(double x_m, double y_m, double heading_rad) {
  return fmt::format("{},{},{}", x_m, y_m, heading_rad * 180 / std::numbers::pi);
}

std::string start_on_line(const Floor& floor) {
  const auto track = sim::Track::load(floor.image.string(), floor.metres_per_pixel);
  if (!track) throw std::runtime_error(track.problem());
  const std::optional<sim::Pose> start = sim::start_on(sim::skeleton(*track));
  if (!start)
    throw std::runtime_error("there is no line to start on in " + floor.image.string() + "; name --start");
  return pose_text(start->at.x_m, start->at.y_m, start->heading_rad);
}

// The start pose of the specification belongs to its own track. On any other, the robot starts on the line.
std::string start_pose(const spec::Simulation& simulation, const Floor& floor, const LaunchOptions& options) {
  if (!options.start.empty()) return options.start;
  if (!options.track.empty() || !simulation.track->start_x_m) return start_on_line(floor);
  return pose_text(*simulation.track->start_x_m, *simulation.track->start_y_m,
                   simulation.track->start_heading_rad.value_or(0));
}

void add_floor(Command& command, const spec::Simulation& simulation, const Floor& floor,
               const LaunchOptions& options) {
  append(command,
         {"--track", floor.image.string(), "--metres-per-pixel", fmt::format("{}", floor.metres_per_pixel),
          "--start=" + start_pose(simulation, floor, options)});
  if (simulation.track) append(command, {"--footprint", fmt::format("{}", simulation.track->footprint_m)});
}

void add_world(Command& command, const Specification& specification, const LaunchOptions& options) {
  const spec::Simulation& simulation = *specification.model.simulation;
  const std::string& file = options.world.empty() ? simulation.world : options.world;
  if (!file.empty()) append(command, {"--world", asset(file, specification.project, "worlds").string()});
  const auto world = world_of(simulation, specification.project, options.world);
  if (!world) {  // the drivers are C++ classes
    if (!simulation.use_checks.empty()) add_devices(command, specification, options);
    return;
  }
  append(command, {"--world-library", world->library.string()});
  if (const std::optional<Floor> floor = floor_of(specification, options))
    add_floor(command, simulation, *floor, options);
  add_devices(command, specification, options);
}

// The real buffers that have no driver for a run of this kind.
std::vector<std::string> missing_drivers(const spec::Model& model, const LaunchOptions& options,
                                         bool simulated) {
  const std::vector<std::string> without_real = model.without_driver(model.drivers);
  if (!simulated) return without_real;
  const auto is_hardware = [&](const std::string& buffer) {
    return std::ranges::any_of(options.hardware,
                               [&](const std::string& name) { return is_in(buffer, name); }) &&
           std::ranges::find(without_real, buffer) == without_real.end();
  };
  std::vector<std::string> missing =
      model.without_driver(model.simulation ? model.simulation->drivers : std::vector<spec::Driver>());
  std::erase_if(missing, is_hardware);
  return missing;
}

std::string hint_for(const std::string& buffer, const spec::Model& model, const LaunchOptions& options,
                     bool simulated) {
  if (!simulated) {
    std::string hint = fmt::format(
        "hint: name a class of src/drivers.hpp under `drivers:` of the specification, for example\n"
        "      {}: {{ cpp: Motor }}\n",
        buffer);
    if (model.simulation && missing_drivers(model, options, true).empty())
      hint += fmt::format("      `tessera run --world {}` runs it in its simulated world, in real time.\n",
                          options.spec);
    return hint;
  }
  std::string hint = fmt::format(
      "hint: name a part of the world or a class of src/drivers.hpp under `drivers:` of `simulation:`, for "
      "example\n"
      "      {}: {{ cpp: SimulatedMotor }}\n",
      buffer);
  if (model.simulation && model.simulation->has_world())
    hint += fmt::format("      `tessera world {}` lists what the world has.\n", options.spec);
  if (const auto without = model.without_driver(model.drivers);
      std::ranges::find(without, buffer) == without.end())
    hint += fmt::format("      A simulation never opens real drivers, unless --hardware {} asks for it.\n",
                        buffer);
  return hint;
}

}  // namespace

std::optional<Floor> floor_of(const Specification& specification, const LaunchOptions& options) {
  const std::optional<spec::Simulation>& simulation = specification.model.simulation;
  const spec::Track* track = simulation && simulation->track ? &*simulation->track : nullptr;
  Floor floor;
  if (track != nullptr) floor.metres_per_pixel = track->metres_per_pixel;
  if (options.metres_per_pixel > 0) floor.metres_per_pixel = options.metres_per_pixel;
  if (!options.track.empty())
    floor.image = asset(options.track, options.base, "tracks");
  else if (track != nullptr)
    floor.image = asset(track->image, specification.project, "tracks");
  else
    return std::nullopt;
  return floor;
}

std::vector<GivenParameter> given_parameters(const Specification& specification,
                                             const LaunchOptions& options) {
  const fs::path file = options.parameters.empty() ? specification.project / file_names::parameters
                                                   : fs::path(options.parameters);
  std::vector<GivenParameter> given;
  if (!options.parameters.empty() || fs::exists(file)) given = read_parameter_file(file);
  for (const std::string& assignment : options.set) given.push_back(read_assignment(assignment));
  return given;
}

std::vector<std::string> parameter_values(const Specification& specification, const LaunchOptions& options) {
  std::vector<std::string> values;
  for (const GivenParameter& one : given_parameters(specification, options))
    values.push_back(one.path + "=" + one.value);
  return values;
}

bool every_real_buffer_has_driver(const LaunchOptions& options, bool simulated, Listener& listener) {
  struct : Listener {
    void say(std::string_view) override {}
    void progress(std::string_view) override {}
  } nobody;  // the build reports what is wrong with the specification
  const std::optional<Specification> specification = read(options.spec, nobody);
  if (!specification) return true;
  const std::vector<std::string> missing = missing_drivers(specification->model, options, simulated);
  for (const std::string& buffer : missing)
    listener.complain(
        fmt::format("the real buffer {} has no {}driver", buffer, simulated ? "simulated " : ""));
  if (!missing.empty()) listener.say(hint_for(missing.front(), specification->model, options, simulated));
  return missing.empty();
}

Command controller_command(const Controller& controller, const LaunchOptions& options,
                           const std::string& mode, bool simulated) {
  const Specification& specification = controller.specification;
  const RunFiles files = run_files(options);
  Command command{controller.program.string(),
                  mode,
                  "--record",
                  files.recording.string(),
                  "--record-values",
                  options.record_values,
                  "--summary",
                  files.summary.string(),
                  "--seed",
                  std::to_string(options.seed),
                  "--project",
                  specification.project.string()};
  if (options.also) command.push_back("--also");
  if (options.no_monitor && mode == "run") command.push_back("--no-monitor");
  if (options.managed && mode == "run") command.push_back("--managed");
  if (options.progress) command.push_back("--progress");
  const std::string limit = options.record_limit.empty() ? usual_record_limit : options.record_limit;
  if (limit != "none") append(command, {"--record-limit", limit});
  if (options.accept_stuck) command.push_back("--accept-stuck");
  if (!options.duration.empty()) append(command, {"--for", options.duration});
  for (const std::string& value : parameter_values(specification, options)) append(command, {"--set", value});
  for (const std::string& fault : options.inject) append(command, {"--inject", fault});
  for (const std::string& path : options.hardware) append(command, {"--hardware", path});
  if (!options.network.empty() && mode == "simulate") append(command, {"--network", options.network});
  if (simulated && mode == "run") command.push_back("--simulated");
  if (simulated && specification.model.simulation) add_world(command, specification, options);
  if (options.ros2_arguments && mode == "run") {
    command.push_back("--ros-args");
    command.insert(command.end(), options.ros2_arguments->begin(), options.ros2_arguments->end());
    command.push_back("--");
  }
  return command;
}

fs::path death_note(const RunFiles& files) { return files.summary.parent_path() / "death.txt"; }

Command with_death_note(Command command, const fs::path& note) {
  append(command, {"--death-note", note.string(), "--parent", std::to_string(getpid())});
  return command;
}

}  // namespace tessera::project
