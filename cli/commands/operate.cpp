#include <fmt/core.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/running_controller.hpp"
#include "cli/terminal.hpp"

/// Commands of an operator to a running controller: `tessera set`, `emergency-stop`, `reset`.
namespace tessera::cli {

namespace {

using nlohmann::json;

struct OperateOptions {
  std::vector<std::string> values;
  std::string which, why;
};

constexpr std::chrono::seconds patience{2};
constexpr int question = 1;

bool tell(RunningController& controller, json command) {
  controller.be_patient_for(patience);
  command["id"] = question;
  // Text that is not UTF-8 names nothing; the controller reports that.
  return controller.send(command.dump(-1, ' ', false, json::error_handler_t::replace) + "\n");
}

/// The answer of the controller: what is wrong; empty: nothing.
std::string answer_of(RunningController& controller) {
  // Besides answers, the controller sends its state several times a second, so there are
  // lines as long as it lives.
  const auto end = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < end) {
    const std::optional<std::string> said = controller.line();
    if (!said) break;
    const json answer = json::parse(*said, nullptr, /*allow_exceptions=*/false);
    if (answer.is_object() && answer.value("answer", 0) == question) return answer.value("error", "");
  }
  return controller.name() + " has ended, or does not answer";
}

std::string ask(RunningController& controller, json command) {
  tell(controller, std::move(command));
  return answer_of(controller);
}

int set_command(const OperateOptions& options) {
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

/// Stops all controllers unless one is named: in an emergency, nobody has time to look up names.
int emergency_stop_command(const OperateOptions& options) {
  std::vector<RunningController> controllers = find_controllers(options.which);
  json command{{"command", "emergency_stop"}};
  if (!options.why.empty()) command["why"] = options.why;
  // The command is sent to all before the first answer is waited for.
  for (RunningController& one : controllers) tell(one, command);
  int code = controllers.empty() ? failed : ok;
  for (RunningController& one : controllers) {
    if (const std::string wrong = answer_of(one); wrong.empty())
      fmt::print("{}: emergency stop\n", one.name());
    else
      code = complain(wrong + ": nobody knows whether its devices are safe");
  }
  return code;
}

int reset_command(const OperateOptions& options) {
  std::optional<RunningController> controller = find_controller(options.which);
  if (!controller) return failed;
  const std::string wrong = ask(*controller, {{"command", "reset"}});
  return wrong.empty() ? ok : complain(wrong);
}

void declare_controller(Subcommand& command, OperateOptions& options,
                        const char* meaning = "Its system or its process; needed if several run") {
  command.option("--controller", options.which, meaning);
}

}  // namespace

void add_set(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("set", "Change parameters of a controller that runs in real time");
  auto options = std::make_shared<OperateOptions>();
  command.option("values", options->values, "PATH=VALUE, as with --set: v=0.3, robot.control.v=0.3")
      .required();
  declare_controller(command, *options);
  command.footer(
      "A value that does not fit the parameter's type and range is refused. A subsystem takes the new value\n"
      "just before it calls a transition function, and the recording says when.\n"
      "Example: tessera set v=0.15 robot.control.w=1");
  command.callback([options, &exit_code] { exit_code = set_command(*options); });
}

void add_emergency_stop(CommandLine& app, int& exit_code) {
  Subcommand command =
      app.add("emergency-stop",
              "Give all devices of all running controllers their safe command until `tessera reset`");
  auto options = std::make_shared<OperateOptions>();
  declare_controller(command, *options, "Only those of this system, or this process");
  command.option("--why", options->why, "Said on its terminal and in its recording");
  command.footer(
      "This is no substitute for an emergency stop in hardware: it needs the controller, this computer and\n"
      "the connection between them.");
  command.callback([options, &exit_code] { exit_code = emergency_stop_command(*options); });
}

void add_reset(CommandLine& app, int& exit_code) {
  Subcommand command =
      app.add("reset", "End the emergency stop of a running controller: its devices move again");
  auto options = std::make_shared<OperateOptions>();
  declare_controller(command, *options);
  command.callback([options, &exit_code] { exit_code = reset_command(*options); });
}

}  // namespace tessera::cli
