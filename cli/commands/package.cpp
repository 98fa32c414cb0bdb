#include "project/packaging/package.hpp"

#include <fmt/ranges.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "project/deployed_run.hpp"
#include "project/files/file_names.hpp"
#include "project/files/installation.hpp"
#include "project/packaging/debian_packages.hpp"
#include "project/packaging/ros2_package.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct PackageCommandOptions : LaunchOptions {
  std::string ros2;  ///< name of the package, or `of_system`; empty: no package of ROS 2
  std::string output = ".", format = "archive", groups, architecture, runtime;
  PackageOptions package;
};

/// nullopt: the processor of this machine. Throws std::runtime_error if the other one is not installed.
std::optional<OtherProcessor> processor_of(const PackageCommandOptions& options) {
  const std::string& name = options.architecture;
  if (name.empty() || (options.runtime.empty() && name == architecture_of_this_machine()))
    return std::nullopt;
  const std::filesystem::path usual = Installation::find().carrier_library.parent_path() / name;
  OtherProcessor processor{
      name,
      std::filesystem::absolute(options.runtime.empty() ? usual : std::filesystem::path(options.runtime))};
  if (!std::filesystem::exists(processor.cmake_package() / "toolchain.cmake"))
    throw std::runtime_error(fmt::format(
        "there is no runtime for {} in {}; --runtime names its folder, and docs/use/service.md says how "
        "it is made",
        name, processor.runtime.string()));
  return processor;
}

void show(const Package& package) {
  const auto kilobytes = std::filesystem::file_size(package.file) / 1000;
  fmt::print("{} ({} kB)", package.file.string(), kilobytes);
  if (!package.host.empty()) fmt::print(" for {}", package.host);
  if (!package.processes.empty()) fmt::print(": {}", fmt::join(package.processes, ", "));
  fmt::print("\n  needs {}\n", fmt::join(package.needs, ", "));
}

constexpr const char* of_system = "-";

int make_for_ros2(const PackageCommandOptions& options) {
  const std::optional<Specification> specification = read(options.spec, terminal());
  if (!specification) return exit_code_without_net();
  Ros2PackageOptions package{.name = options.ros2 == of_system ? "" : options.ros2,
                             .version = options.package.version,
                             .folder = options.output == "." ? "" : options.output};
  const Result<std::filesystem::path> made = make_ros2_package(*specification, package);
  if (!made) return complain(made.problem());
  const std::string name = package.name.empty() ? specification->model.system : package.name;
  fmt::print(
      "{0}: build it with `colcon build --packages-select {1}`, start it with `ros2 launch {1} "
      "{1}.launch.py`\n",
      made->string(), name);
  if (std::filesystem::exists(specification->project / file_names::parameters))
    fmt::print("note: the launch file takes config/params.yaml, not {}\n", file_names::parameters);
  return ok;
}

int package_command(PackageCommandOptions& options) {
  if (!options.ros2.empty()) return make_for_ros2(options);
  PackageOptions& package = options.package;
  package.folder = options.output;
  package.format = options.format == "deb" ? PackageOptions::Format::debian : PackageOptions::Format::archive;
  package.groups = names_between_commas(options.groups);
  if (!every_real_buffer_has_driver(options, /*simulated=*/false, terminal())) return failed;
  const std::optional<Specification> specification = read(options.spec, terminal());
  if (!specification) return exit_code_without_net();
  if (const std::optional<Problem> wrong = wrong_with(package, specification->model))
    return complain(wrong->text), usage;
  package.parameters = parameter_values(*specification, options);
  const std::optional<OtherProcessor> processor = processor_of(options);
  const std::optional<Controller> controller =
      make_controller(options.spec, {.gate = options.gate, .processor = processor}, terminal());
  if (!controller) return exit_code_without_net();
  package.libraries =
      processor ? processor->runtime / "lib/tessera" : Installation::find().carrier_library.parent_path();
  if (processor) package.architecture = processor->architecture;
  for (const Package& made : make_packages(*controller, package, terminal())) show(made);
  return ok;
}

}  // namespace

void add_package(CommandLine& app) {
  Subcommand command =
      app.add("package", "Build the controller, and pack it with its libraries and units for the robot");
  PackageCommandOptions& options = command.runs(package_command);
  declare_specification(command, options.spec);
  command.option("-o,--output", options.output, "Folder for the packages").shows_default();
  command.option("--format", options.format, "deb: a package of Debian; archive: a .tar.gz")
      .one_of({"archive", "deb"})
      .shows_default();
  Option ros2 =
      command.flag("--ros2", options.ros2, of_system,
                   "A package of ROS 2 for colcon, with a launch file, written into the project, or as a "
                   "copy into --output; --ros2=NAME names it");
  ros2.excludes(command.declared("--format"));
  command.option("--host", options.package.host,
                 "Only the package of this machine of `deploy` (default: one for each)");
  command.option("--arch", options.architecture,
                 "Kind of processor of the robot, as Debian calls it: arm64 (default: that of this machine)");
  command
      .option("--runtime", options.runtime,
              "Folder with Tessera's runtime for --arch (default: lib/tessera/ARCH of this installation)")
      .needs(command.declared("--arch"));
  command.option("--release", options.package.version, "Version of the package").shows_default();
  command.option("--groups", options.groups,
                 "Groups of the user who runs the units, for devices: dialout,gpio");
  command.option("--parameters", options.parameters,
                 "File of parameters to pack (default: params.yaml of the project)");
  command.option("--set", options.set, "PATH=VALUE: a parameter to pack, after those of the file").repeated();
  declare_verification_gate(command, options.gate);
  for (const char* other :
       {"--host", "--arch", "--groups", "--parameters", "--set", "--verify-timeout", "--accept-violations"})
    ros2.excludes(command.declared(other));
  command.footer(
      "Examples:\n  tessera package --ros2 --output ~/ws/src\n  tessera package --format deb --output "
      "packages\n"
      "  tessera package --host cart.local --release 1.2   (docs/use/service.md)");
}

}  // namespace tessera::cli
