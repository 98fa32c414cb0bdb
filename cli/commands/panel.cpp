#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "cli/watching/offers.hpp"
#include "cli/watching/running_controller.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/given_values.hpp"

/// `tessera panel`: a panel for an operator without a browser.
namespace tessera::cli {

namespace {

using Clock = std::chrono::steady_clock;
using PanelCommand = command::Panel;

struct PanelOptions {
  std::string path, which, duration = "500ms";
  std::vector<std::string> values;
};

constexpr std::chrono::milliseconds repetition{100};
std::atomic<bool> interrupted{false};

/// nullopt: the mistake has been printed.
std::optional<PanelCommand::Value> panel_value(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  double number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem == std::errc() && end == text.data() + text.size() && std::isfinite(number)) return number;
  complain("'" + text + "' is neither a number nor true or false");
  return std::nullopt;
}

std::optional<PanelCommand> panel_command_of(const PanelOptions& options) {
  PanelCommand command{options.path, fmt::format("terminal {}", getpid()), {}};
  command.values.emplace();
  for (const std::string& one : options.values) {
    const std::size_t equals = one.find('=');
    if (equals == std::string::npos || equals == 0) {
      complain("'" + one + "' is not FIELD=VALUE");
      return std::nullopt;
    }
    const auto value = panel_value(one.substr(equals + 1));
    if (!value) return std::nullopt;
    command.values->insert_or_assign(one.substr(0, equals), *value);
  }
  return command;
}

/// nullopt: the process has ended, or does not answer.
std::optional<CommandAnswer> panel_answer(RunningController& controller, const PanelCommand& command) {
  return controller.tell(command) ? controller.answer() : std::nullopt;
}

/// The process that has the panel and has taken the command; nullptr: the mistake has been printed.
RunningController* operate(std::vector<SeenController>& processes, const PanelCommand& command) {
  std::string unknown = "no controller answers";
  for (SeenController& one : processes) {
    const auto answer = panel_answer(one.controller, command);
    if (answer && !answer->problem) return &one.controller;
    if (answer) unknown = answer->problem->text;
    if (answer && !answer->elsewhere) break;
  }
  complain(unknown);
  return nullptr;
}

int panel_command(const PanelOptions& options) {
  const std::optional<Duration> duration = parse_duration(options.duration);
  if (!duration) return complain("'" + options.duration + "' is no time such as 2s");
  const std::optional<PanelCommand> command = panel_command_of(options);
  if (!command) return failed;
  FoundControllers found = find_controllers(options.which);
  complain_of_silent(found.silent, "if it has the panel, nothing comes to it");
  std::vector<SeenController> processes = first_look(std::move(found.running));
  if (processes.empty()) return failed;
  if (processes.size() > 1 && !common_deployment(processes)) return complain_of_several(processes);
  if (options.values.empty()) return list_panels(processes, options.path);
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  const auto end = Clock::now() + *duration;
  RunningController* const controller = operate(processes, *command);
  if (controller == nullptr) return failed;
  int code = ok;
  while (code == ok && !interrupted && Clock::now() < end) {
    std::this_thread::sleep_for(std::min<Clock::duration>(repetition, end - Clock::now()));
    if (interrupted || Clock::now() >= end) break;
    const auto answer = panel_answer(*controller, *command);
    if (!answer) code = complain(controller->name() + " has ended, or does not answer");
    if (answer && answer->problem) code = complain(answer->problem->text);
  }
  static_cast<void>(panel_answer(*controller, {command->path, command->who, {}}));
  return code;
}

}  // namespace

void add_panel(CommandLine& app) {
  Subcommand command = app.add("panel", "Operate a panel of a controller that runs in real time");
  PanelOptions& options = command.runs(panel_command);
  command.option("path", options.path, "The real buffer with the panel: robot.console.drive");
  command.option(
      "values", options.values,
      "FIELD=VALUE: forward=0.3, horn=true; the rest is neutral. Without any, it lists what there is");
  command.option("--for", options.duration, "Hold the values for so long (500ms by default)");
  command.option("--controller", options.which,
                 "Its system, its process (cart[0]) or its process number; needed if several run");
  command.footer(
      "Without values it lists the panels, or the one of the path, with values, units and ranges.\n"
      "The values are repeated while the command runs. When it ends, also by Ctrl+C, the panel is neutral.\n"
      "Example: tessera panel robot.console.drive forward=0.3 turn=0.1 --for 2s");
}

}  // namespace tessera::cli
