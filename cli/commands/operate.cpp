#include <fmt/core.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/running_controller.hpp"
#include "cli/terminal.hpp"
#include "project/process/control_messages.hpp"
#include "tessera/result.hpp"

/// Commands of an operator to a running controller: `tessera set`, `emergency-stop`, `reset`.
namespace tessera::cli {

namespace {

struct OperateOptions {
  std::vector<std::string> values;
  std::string which, why;
};

constexpr std::chrono::seconds patience{2};
constexpr int question = 1;

bool tell(RunningController& controller, const project::ControlCommand& command) {
  controller.be_patient_for(patience);
  return controller.send(project::line_of(command, question));
}

/// What the controller answers: what is wrong; nullopt: nothing.
std::optional<Problem> answer_of(RunningController& controller) {
  // Beside answers it sends what it does, several times a second: lines come as long as it lives.
  const auto end = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < end) {
    const std::optional<std::string> said = controller.line();
    if (!said) break;
    std::optional<project::ControlLine> line = project::read_control_line(*said);
    auto* answer = line ? std::get_if<project::CommandAnswer>(&*line) : nullptr;
    if (answer != nullptr && answer->id == question)
      return answer->error.empty() ? std::nullopt : std::optional(Problem{std::move(answer->error)});
  }
  return Problem{controller.name() + " has ended, or does not answer"};
}

std::optional<Problem> ask(RunningController& controller, const project::ControlCommand& command) {
  tell(controller, command);
  return answer_of(controller);
}

int set_command(const OperateOptions& options) {
  std::optional<RunningController> controller = find_controller(options.which);
  if (!controller) return failed;
  int code = ok;
  for (const std::string& one : options.values) {
    const std::size_t equals = one.find('=');
    if (equals == std::string::npos || equals == 0) return complain("'" + one + "' is not PATH=VALUE");
    const project::command::Set command{one.substr(0, equals), one.substr(equals + 1)};
    if (const std::optional<Problem> wrong = ask(*controller, command)) code = complain(wrong->text);
  }
  return code;
}

/// Stops all controllers unless one is named: in an emergency, nobody has time to look up names.
int emergency_stop_command(const OperateOptions& options) {
  std::vector<RunningController> controllers = find_controllers(options.which);
  const project::command::EmergencyStop command{options.why};
  // All are told before one is waited for.
  for (RunningController& one : controllers) tell(one, command);
  int code = controllers.empty() ? failed : ok;
  for (RunningController& one : controllers) {
    if (const std::optional<Problem> wrong = answer_of(one); !wrong)
      fmt::print("{}: emergency stop\n", one.name());
    else
      code = complain(wrong->text + ": nobody knows whether its devices are safe");
  }
  return code;
}

int reset_command(const OperateOptions& options) {
  std::optional<RunningController> controller = find_controller(options.which);
  if (!controller) return failed;
  const std::optional<Problem> wrong = ask(*controller, project::command::Reset{});
  return wrong ? complain(wrong->text) : ok;
}

void declare_controller(
    Subcommand& command, OperateOptions& options,
    const char* meaning = "Its system, its process (cart[0]) or its process number; needed if several run") {
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
