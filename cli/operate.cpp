#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/running_controller.hpp"
#include "cli/terminal.hpp"

/// What an operator does to a controller that runs: `tessera set`, `emergency-stop`, `reset`.
namespace tessera::cli {

namespace {

using nlohmann::json;

struct Options {
  std::vector<std::string> values;
  std::string which, why;
};

/// What the controller answers: what is wrong; empty: nothing.
std::string ask(RunningController& controller, json command) {
  static int last = 0;
  command["id"] = ++last;
  // Text that is not UTF-8 names nothing: the controller says so.
  const std::string line = command.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  if (!controller.send(line)) return "the controller has ended";
  while (const std::optional<std::string> said = controller.line()) {
    const json answer = json::parse(*said, nullptr, /*allow_exceptions=*/false);
    if (answer.is_object() && answer.value("answer", 0) == last) return answer.value("error", "");
  }
  return "the controller has ended";
}

int set_command(const Options& options) {
  std::optional<RunningController> controller = find_controller(options.which);
  if (!controller) return failed;
  int code = ok;
  for (const std::string& one : options.values) {
    const std::size_t equals = one.find('=');
    if (equals == std::string::npos || equals == 0) return complain("'" + one + "' is not PATH=VALUE");
    const json command{
        {"command", "set"}, {"path", one.substr(0, equals)}, {"value", one.substr(equals + 1)}};
    if (const std::string wrong = ask(*controller, command); !wrong.empty()) code = complain(wrong);
  }
  return code;
}

int plain_command(const Options& options, const char* name) {
  std::optional<RunningController> controller = find_controller(options.which);
  if (!controller) return failed;
  json command{{"command", name}};
  if (!options.why.empty()) command["why"] = options.why;
  const std::string wrong = ask(*controller, command);
  return wrong.empty() ? ok : complain(wrong);
}

void declare_controller(CLI::App& command, Options& options) {
  command.add_option("--controller", options.which, "Its system or its process; needed if several run");
}

}  // namespace

void add_set(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("set", "Change parameters of a controller that runs in real time");
  auto options = std::make_shared<Options>();
  command->add_option("values", options->values, "PATH=VALUE, as with --set: v=0.3, robot.control.v=0.3")
      ->required();
  declare_controller(*command, *options);
  command->footer(
      "A value that does not fit the parameter's type and range is refused. A subsystem takes the new value\n"
      "just before it calls a transition function, and the recording says when.\n"
      "Example: tessera set v=0.15 robot.control.w=1");
  command->callback([options, &exit_code] { exit_code = set_command(*options); });
}

void add_emergency_stop(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "emergency-stop", "Give all devices of a running controller their safe command until `tessera reset`");
  auto options = std::make_shared<Options>();
  declare_controller(*command, *options);
  command->add_option("--why", options->why, "Said on its terminal and in its recording");
  command->footer(
      "This is no substitute for an emergency stop in hardware: it needs the controller, this computer and\n"
      "the connection between them.");
  command->callback([options, &exit_code] { exit_code = plain_command(*options, "emergency_stop"); });
}

void add_reset(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("reset", "End the emergency stop of a running controller: its devices move again");
  auto options = std::make_shared<Options>();
  declare_controller(*command, *options);
  command->callback([options, &exit_code] { exit_code = plain_command(*options, "reset"); });
}

}  // namespace tessera::cli
