#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/recordings/coverage.hpp"
#include "cli/terminal.hpp"
#include "project/build/controller.hpp"
#include "project/build/line_coverage.hpp"
#include "project/process/process.hpp"

namespace tessera::cli {

using namespace project;
namespace fs = std::filesystem;

namespace {

struct TestOptions {
  std::string spec = ".", filter;
  bool debug = false, coverage = false;
  VerificationGate gate;
};

/// "Follow.SteersByTheTable" of each test that the command would run.
std::vector<std::string> names_of_tests(Command command) {
  command.emplace_back("--gtest_list_tests");
  std::vector<std::string> names;
  std::string suite;
  static_cast<void>(capture(command, [&](std::string_view line) {
    // The name of a suite, "Follow.", is not indented; its tests are, and some have a comment.
    line = line.substr(0, line.find("  #"));
    while (line.ends_with('\n') || line.ends_with(' ')) line.remove_suffix(1);
    if (line.starts_with("  "))
      names.push_back(suite + std::string(line.substr(2)));
    else if (line.ends_with('.'))
      suite = line;
  }));
  return names;
}

/// A command that runs no test at all checks no function, so it is an error.
int complain_of_no_tests(const std::string& program, const std::string& filter) {
  const std::vector<std::string> all = names_of_tests({program});
  if (all.empty()) return complain("test/ has files, and no test in them: write TEST(Suite, Name) { ... }");
  constexpr std::size_t shown = 8;
  std::string list;
  for (std::size_t at = 0; at < std::min(all.size(), shown); ++at) list += (at == 0 ? "" : ", ") + all[at];
  if (all.size() > shown) list += fmt::format(" and {} more", all.size() - shown);
  return complain(fmt::format("no test matches --filter {}; there are {}", filter, list));
}

/// Prints the lines of the user's functions that the tests have not reached, and the parts of the net that
/// their simulations have not reached.
void report_reached(const Specification& specification, const fs::path& recordings) {
  std::size_t all = 0, missed = 0;
  fmt::print("\nlines of src/ that the tests have reached:\n");
  for (const LineCoverage& one : line_coverage(specification)) {
    all += one.lines;
    missed += one.missed.size();
    fmt::print("  {:<32} {:>4} of {}{}\n", one.file.string(), one.lines - one.missed.size(), one.lines,
               one.missed.empty() ? "" : ", not " + ranges_of(one.missed));
  }
  if (all == 0)
    fmt::print("  unknown: the data that the compiler has left names no line of src/\n");
  else
    fmt::print("  {:<32} {:>4} of {}\n", "all", all - missed, all);
  CoverageInput input(specification);
  bool any = false;
  for (const auto& entry : fs::directory_iterator(recordings)) {
    input.add_file(entry.path().string());
    any = true;
  }
  if (!any) {
    fmt::print("\nno test runs the system (docs/use/testing.md), so nothing is said about the net\n");
    return;
  }
  fmt::print("\nthe net, in the runs of the tests:\n");
  report_coverage(input, shown_only, true);
}

/// Runs the tests of a project, and deletes the recordings of their runs.
int run_with_coverage(const Specification& specification, const Command& command) {
  std::string folder = (fs::temp_directory_path() / "tessera-coverage-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return complain("cannot make a folder in " + folder);
  setenv("TESSERA_TEST_RECORDINGS", folder.c_str(), 1);
  clear_line_coverage(specification);
  const int code = run(command).code;
  try {
    report_reached(specification, folder);
  } catch (...) {
    fs::remove_all(folder);
    throw;
  }
  fs::remove_all(folder);
  return code == ok || code == interrupted ? code : failed;
}

int test_command(const TestOptions& options) {
  std::error_code ignored;
  const std::filesystem::path given(options.spec);
  const std::filesystem::path project = std::filesystem::is_directory(given) ? given : given.parent_path();
  if (!std::filesystem::exists(project / "test", ignored))
    return complain(fmt::format("{} has no test/ folder: put GoogleTest files there",
                                std::filesystem::absolute(project).string()));
  const std::optional<Controller> tests = make_controller(
      options.spec,
      {.debug = options.debug, .target = "tests", .gate = options.gate, .coverage = options.coverage},
      terminal());
  if (!tests) return exit_code_without_net();
  Command command{tests->program.string()};
  if (!options.filter.empty()) command.push_back("--gtest_filter=" + options.filter);
  if (names_of_tests(command).empty()) return complain_of_no_tests(tests->program.string(), options.filter);
  if (options.coverage) return run_with_coverage(tests->specification, command);
  const int code = run(command).code;
  return code == ok || code == interrupted ? code : failed;
}

}  // namespace

void add_test(CommandLine& app) {
  Subcommand command = app.add("test", "Build and run the project's own GoogleTests of its functions");
  TestOptions& options = command.runs(test_command);
  declare_specification(command, options.spec);
  command.option("--filter", options.filter, "GoogleTest filter, e.g. Follow.*");
  command.flag("--debug", options.debug, "Build the tests for gdb");
  command
      .flag("--coverage", options.coverage,
            "Show which lines of src/, and which parts of the net, the tests have not reached")
      .excludes(command.declared("--debug"));
  declare_verification_gate(command, options.gate);
  command.footer("Example: tessera test --filter 'Follow.*'");
}

}  // namespace tessera::cli
