#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "project/build/controller.hpp"
#include "project/process/process.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct TestOptions {
  std::string spec = ".", filter;
  bool debug = false;
  VerificationGate gate;
};

/// "Follow.SteersByTheTable" of each test that the command would run.
std::vector<std::string> names_of_tests(Command command) {
  command.emplace_back("--gtest_list_tests");
  std::vector<std::string> names;
  std::string suite;
  static_cast<void>(capture(command, [&](std::string_view line) {
    // The name of a suite, "Follow.", is not indented; its tests are, some with a comment.
    line = line.substr(0, line.find("  #"));
    while (line.ends_with('\n') || line.ends_with(' ')) line.remove_suffix(1);
    if (line.starts_with("  "))
      names.push_back(suite + std::string(line.substr(2)));
    else if (line.ends_with('.'))
      suite = line;
  }));
  return names;
}

/// Running no test at all says nothing about the functions, so it is an error.
int complain_of_no_tests(const std::string& program, const std::string& filter) {
  const std::vector<std::string> all = names_of_tests({program});
  if (all.empty()) return complain("test/ has files, and no test in them: write TEST(Suite, Name) { ... }");
  constexpr std::size_t shown = 8;
  std::string list;
  for (std::size_t at = 0; at < std::min(all.size(), shown); ++at) list += (at == 0 ? "" : ", ") + all[at];
  if (all.size() > shown) list += fmt::format(" and {} more", all.size() - shown);
  return complain(fmt::format("no test matches --filter {}; there are {}", filter, list));
}

int test_command(const TestOptions& options) {
  std::error_code ignored;
  const std::filesystem::path given(options.spec);
  const std::filesystem::path project = std::filesystem::is_directory(given) ? given : given.parent_path();
  if (!std::filesystem::exists(project / "test", ignored))
    return complain(fmt::format("{} has no test/ folder: put GoogleTest files there",
                                std::filesystem::absolute(project).string()));
  const std::optional<Controller> tests =
      make_controller(options.spec, {options.debug, "tests", options.gate}, terminal());
  if (!tests) return exit_code_without_net();
  Command command{tests->program.string()};
  if (!options.filter.empty()) command.push_back("--gtest_filter=" + options.filter);
  if (names_of_tests(command).empty()) return complain_of_no_tests(tests->program.string(), options.filter);
  return run(command).code == 0 ? ok : failed;
}

}  // namespace

void add_test(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("test", "Build and run the project's own GoogleTests of its functions");
  auto options = std::make_shared<TestOptions>();
  declare_specification(command, options->spec);
  command.option("--filter", options->filter, "GoogleTest filter, e.g. Follow.*");
  command.flag("--debug", options->debug, "Build the tests for gdb");
  declare_verification_gate(command, options->gate);
  command.footer("Example: tessera test --filter 'Follow.*'");
  command.callback([options, &exit_code] { exit_code = test_command(*options); });
}

}  // namespace tessera::cli
