#include <fmt/core.h>

#include <memory>

#include "cli/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "project/controller.hpp"
#include "project/process.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct Options {
  std::string spec = ".", filter;
  bool debug = false;
  Gate gate;
};

int test_command(const Options& options) {
  std::error_code ignored;
  const std::filesystem::path given(options.spec);
  const std::filesystem::path project = std::filesystem::is_directory(given) ? given : given.parent_path();
  if (!std::filesystem::exists(project / "test", ignored))
    return complain(fmt::format("{} has no test/ folder: put GoogleTest files there",
                                std::filesystem::absolute(project).string()));
  const std::optional<Controller> tests =
      make_controller(options.spec, {options.debug, "tests", options.gate}, terminal());
  if (!tests) return refused();
  Command command{tests->program.string()};
  if (!options.filter.empty()) command.push_back("--gtest_filter=" + options.filter);
  return run(command).code == 0 ? ok : failed;
}

}  // namespace

void add_test(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("test", "Build and run the project's own GoogleTests of its functions");
  auto options = std::make_shared<Options>();
  command->add_option("spec", options->spec, "Specification, or the folder of its spec.yaml")
      ->capture_default_str();
  command->add_option("--filter", options->filter, "GoogleTest filter, e.g. Follow.*");
  command->add_flag("--debug", options->debug, "Build the tests for gdb");
  declare_gate(*command, options->gate);
  command->footer("Example: tessera test --filter 'Follow.*'");
  command->callback([options, &exit_code] { exit_code = test_command(*options); });
}

}  // namespace tessera::cli
