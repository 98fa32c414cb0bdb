#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "cli/watching/not_reached.hpp"
#include "cli/watching/offers.hpp"
#include "cli/watching/running_controller.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/monitor.hpp"
#include "tessera/result.hpp"

/// Commands of an operator to a running controller: `tessera set`, `emergency-stop`, `reset`.
namespace tessera::cli {

namespace {

struct OperateOptions {
  std::vector<std::string> values;
  std::string which, why;
};

std::optional<Problem> problem_of(const RunningController& controller,
                                  const std::optional<CommandAnswer>& answer) {
  if (!answer) return Problem{controller.name() + " has ended, or does not answer"};
  return answer->problem;
}

struct FoundSystem {
  std::vector<SeenController> processes;
  int code = failed;  ///< failed: not all that are meant answer, or there is none
};

/// One controller, or all processes of a deployed system: a parameter may be in any of them. No process: there is
/// none, or they cannot be meant together; the reason has been printed. unknown: of those that do not answer.
FoundSystem find_system(const std::string& which, const std::string& unknown) {
  FoundControllers found = find_controllers(which);
  const int code = complain_of_silent(found.silent, unknown);
  std::vector<SeenController> seen = first_look(std::move(found.running));
  if (seen.empty()) return {};
  if (seen.size() == 1 || common_deployment(seen)) return {std::move(seen), code};
  complain_of_several(seen);
  return {};
}

/// Each process that has the parameter takes its value, or tries it. Returns the exit code.
int set_in_all(std::vector<SeenController>& processes, const command::Set& command) {
  for (SeenController& one : processes) one.controller.tell(command);
  bool taken = false, silent = false;
  std::string unknown;
  int code = ok;
  for (SeenController& one : processes) {
    const std::optional<CommandAnswer> answer = one.controller.answer();
    const std::string name = one.snapshot ? one.snapshot->process.value_or("") : one.controller.name();
    if (!answer) {
      silent = true;
      code = complain(name + " has ended, or does not answer: it is unknown whether it takes " +
                      command.path + "=" + command.value);
    } else if (answer->elsewhere) {
      if (answer->problem && answer->problem->text.size() > unknown.size())
        unknown = answer->problem->text;  // with a hint
    } else if (!answer->problem) {
      taken = true;
      if (processes.size() > 1 && !command.only_try)
        fmt::print("{}: {}={}\n", name, command.path, command.value);
    } else {
      taken = true;
      code = complain(processes.size() > 1 ? name + ": " + answer->problem->text : answer->problem->text);
    }
  }
  if (!taken && !silent) code = complain(unknown);
  return code;
}

/// Commands never go over the network, which does not tell who sends them.
void note_not_told(const std::vector<SeenController>& processes, const char* what) {
  NotReached others;
  for (const SeenController& one : processes)
    if (one.snapshot) others.reached(*one.snapshot);
  for (const std::string& text : others.texts())
    fmt::print(stderr, "tessera: note: {}, on other machines: {}\n", what, text);
}

/// Whether several processes were meant.
bool is_system(const std::string& which, const std::vector<SeenController>& processes) {
  return which.empty() || std::ranges::any_of(processes, [&](const SeenController& one) {
           return one.snapshot && one.snapshot->system == which;
         });
}

int set_command(const OperateOptions& options) {
  auto [processes, code] =
      find_system(options.which, options.values.empty() ? "it is unknown which parameters it has"
                                                        : "it is unknown whether it takes the values");
  if (processes.empty()) return failed;
  if (options.values.empty()) return std::max(code, list_parameters(processes));
  std::vector<command::Set> commands;
  for (const std::string& one : options.values) {
    const std::size_t equals = one.find('=');
    if (equals == std::string::npos || equals == 0) return complain("'" + one + "' is not PATH=VALUE");
    commands.push_back({one.substr(0, equals), one.substr(equals + 1), /*only_try=*/true});
  }
  // All values or none: half of a change may be worse than either.
  bool all_fit = true;
  for (const command::Set& one : commands) all_fit = set_in_all(processes, one) == ok && all_fit;
  if (!all_fit) return complain("no parameter was changed");
  for (command::Set& one : commands) {
    one.only_try = false;
    if (set_in_all(processes, one) != ok) code = failed;
  }
  if (is_system(options.which, processes)) note_not_told(processes, "not told");
  return code;
}

constexpr const char* unknown_safety = "it is unknown whether its devices are safe";

/// A device has a second for its safe command; only then does the controller answer.
constexpr std::chrono::seconds stop_patience{3};

/// Waits for the answers of controllers that have the command. Returns the exit code.
int confirm_stops(std::vector<RunningController>& controllers, const std::string& which, NotReached& others) {
  const auto end = std::chrono::steady_clock::now() + stop_patience;
  int code = ok;
  for (RunningController& one : controllers) {
    std::optional<Snapshot> first;
    const std::optional<CommandAnswer> answer = one.answer(end, &first);
    if (!answer)
      code =
          complain(one.name() + " has ended, still opens its devices, or does not answer: " + unknown_safety);
    else if (answer->problem)
      code = complain(one.name() + ": NOT SAFE: " + answer->problem->text);
    else
      fmt::print("{}: emergency stop\n", one.name());
    others.tried(one.name());
    if (first && (which.empty() || which == first->system)) others.reached(*first);
  }
  return code;
}

/// Stops all controllers unless one is named: in an emergency, there is no time to look up names.
int emergency_stop_command(const OperateOptions& options) {
  const command::EmergencyStop command{options.why};
  // Each gets the command as soon as it is reached: one that hangs must not delay the others.
  FoundControllers found =
      look_for_controllers(options.which, [&](RunningController& one) { one.tell(command); });
  int elsewhere = complain_of_other_folders(options.which);
  if (options.which.empty() && complain_of_unreachable() != ok) elsewhere = failed;
  if (const std::optional<Problem> wrong = wrong_with_monitor_folder())
    elsewhere = complain("it is unknown whether other controllers run: " + wrong->text);
  if (found.none()) return elsewhere == ok ? complain_of_none(options.which) : elsewhere;
  NotReached others;
  int code = confirm_stops(found.running, options.which, others);
  if (complain_of_silent(found.silent, unknown_safety) != ok) code = failed;
  for (const auto& file : found.silent) others.tried(file.stem().string());
  // A stop of some processes is not a stop of the system: the operator must know what may still move.
  for (const std::string& text : others.texts())
    code = complain("NOT STOPPED, because they are on other machines, if they run: " + text +
                    ". Type `tessera emergency-stop` there, too");
  return elsewhere == ok ? code : elsewhere;
}

/// The processes of a deployed system that have an emergency stop. A system must be named, because its
/// devices move again. code: failed if other processes of it do not answer.
int reset_processes(std::vector<SeenController>& processes, const std::string& system, int code) {
  std::vector<SeenController*> stopped;
  for (SeenController& one : processes) {
    if (!one.snapshot)
      code = complain(one.controller.name() +
                      " does not answer: it is unknown whether it has an emergency stop");
    else if (one.snapshot->emergency)
      stopped.push_back(&one);
  }
  if (stopped.empty() && code == ok)
    return complain("no process of " + system + " on this machine has an emergency stop");
  for (SeenController* one : stopped) one->controller.tell(command::Reset{});
  note_not_told(processes, "not reset");
  for (SeenController* one : stopped) {
    if (const std::optional<Problem> wrong = problem_of(one->controller, one->controller.answer()))
      code = complain(one->snapshot->process.value_or("") + ": " + wrong->text);
    else
      fmt::print("{}: the emergency stop is over ({})\n", one->snapshot->process.value_or(""),
                 *one->snapshot->emergency);
  }
  return code;
}

int reset_command(const OperateOptions& options) {
  FoundControllers found = find_controllers(options.which);
  const int code = complain_of_silent(found.silent, "it is unknown whether it has an emergency stop");
  std::vector<SeenController> seen = first_look(std::move(found.running));
  if (seen.empty()) return failed;
  const std::optional<std::string> system = common_deployment(seen);
  if (system && options.which == *system) return reset_processes(seen, *system, code);
  if (seen.size() > 1) {
    complain_of_several(seen);
    if (system) fmt::print(stderr, "hint: `tessera reset {}` resets all of them\n", *system);
    return failed;
  }
  seen.front().controller.tell(command::Reset{});
  const std::optional<Problem> wrong = problem_of(seen.front().controller, seen.front().controller.answer());
  return wrong ? complain(wrong->text) : code;
}

void declare_controller(
    Subcommand& command, OperateOptions& options,
    const char* meaning = "Its system, its process (cart[0]) or its process number; needed if several run") {
  command.option("--controller", options.which, meaning);
}

}  // namespace

void add_set(CommandLine& app) {
  Subcommand command = app.add("set", "Change parameters of a controller that runs in real time");
  OperateOptions& options = command.runs(set_command);
  command.option(
      "values", options.values,
      "PATH=VALUE, as with --set: v=0.3, robot.control.v=0.3; without any, it lists what there is");
  declare_controller(command, options);
  command.footer(
      "Without values it lists all parameters, with their values, units and ranges.\n"
      "A value that does not fit the parameter's type and range is refused, and then no value is set. A "
      "number\n"
      "may have any unit of its quantity: v='30 cm/s'. A subsystem takes the new value\n"
      "just before it calls a transition function, and the recording says when. In a system of several\n"
      "processes, each one on this machine that has the parameter takes it and is named.\n"
      "Example: tessera set v=0.15 robot.control.w=1");
}

void add_emergency_stop(CommandLine& app) {
  Subcommand command =
      app.add("emergency-stop",
              "Give all devices of all running controllers their safe command until `tessera reset`");
  OperateOptions& options = command.runs(emergency_stop_command);
  declare_controller(command, options, "Only those of this system, or this process");
  command.option("--why", options.why, "The reason, for its terminal and its recording");
  command.footer(
      "This is no substitute for an emergency stop in hardware: it needs the controller, this computer and\n"
      "the connection between them. It goes to the controllers of this machine: of a system of several "
      "processes it\n"
      "names those of other machines, which it does not stop. Type it on each.");
}

void add_reset(CommandLine& app) {
  Subcommand command =
      app.add("reset", "End the emergency stop of a running controller: its devices move again");
  OperateOptions& options = command.runs(reset_command);
  command.option("controller,--controller", options.which,
                 "Its system, its process (cart[0]) or its process number; needed if several run");
  command.footer(
      "If a system has several processes, name the system: all its processes on this machine that have an\n"
      "emergency stop are reset.");
}

}  // namespace tessera::cli
