#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "cli/watching/running_controller.hpp"
#include "cli/watching/top_deployment.hpp"
#include "project/launch.hpp"
#include "project/meeting_place.hpp"
#include "project/process/control_reader.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/printable.hpp"

namespace tessera::cli {

namespace {

constexpr const char* hangs = "it is stopped, or hangs";

struct TopOptions {
  std::string which;
  project::NetworkOptions network;
  bool once = false, lines = false;
};

// ---------------------------------------------------------------------------------------------- table

std::string duration_of(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.0f} us", seconds * 1e6);
  if (seconds < 1) return fmt::format("{:.1f} ms", seconds * 1e3);
  return fmt::format("{:.1f} s", seconds);
}

/// "20.0 of 20 Hz": iterations a second between two snapshots.
std::string rate_of(const Snapshot::Subsystem& now, const Snapshot::Subsystem& before, double elapsed_s) {
  const double done = static_cast<double>(now.iterations) - static_cast<double>(before.iterations);
  const std::string kept = elapsed_s > 0 ? fmt::format("{:.1f}", done / elapsed_s) : "-";
  return now.period_s > 0 ? fmt::format("{} of {:.4g} Hz", kept, 1 / now.period_s) : kept + " Hz";
}

std::string state_of(const Snapshot::Subsystem& subsystem) {
  if (subsystem.ended) return "ended";
  if (!subsystem.behaviour) return "-";
  return *subsystem.behaviour + (subsystem.calling ? " *" : "");
}

/// "    free 0.35  side 1", on as many lines as needed.
std::string memory_of(const Snapshot::Subsystem& subsystem) {
  constexpr std::size_t widest = 108, most_lines = 4;
  std::vector<std::string> lines;
  for (const auto& [name, value] : subsystem.memory) {
    const std::string field = name + " " + value;
    if (lines.empty() || (lines.back() + "  " + field).size() > widest)
      lines.push_back("    " + field);
    else
      lines.back() += "  " + field;
  }
  const std::size_t shown = std::min(lines.size(), most_lines);
  return fmt::format("{}{}",
                     fmt::join(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(shown), "\n"),
                     shown == 0             ? ""
                     : lines.size() > shown ? " ...\n"
                                            : "\n");
}

/// "    overtime: 3 calls longer than its takes; its thread went on late 2 times, at most 1.2 ms"
std::string overtime_of(const Snapshot::Subsystem& one) {
  std::string text;
  if (one.slow_calls > 0)
    text = fmt::format("{} call{} longer than {} takes", one.slow_calls, one.slow_calls == 1 ? "" : "s",
                       one.slow_calls == 1 ? "its" : "their");
  if (one.late_wakeups > 0)
    text += fmt::format("{}its thread went on later than the latency {} time{}, at most {} late",
                        text.empty() ? "" : "; ", one.late_wakeups, one.late_wakeups == 1 ? "" : "s",
                        duration_of(one.latest_wakeup_s));
  return text.empty() ? text : "    overtime: " + text + "\n";
}

/// The table and the details of one controller.
std::string table(const Snapshot& now, const Snapshot& before) {
  const double elapsed_s = now.time_s - before.time_s;
  std::string text =
      fmt::format("{}  process {}  {:.1f} s  net {}\n\n{:<28} {:<20} {:>18} {:>10} {:>10} {:>9} {:>7}\n",
                  now.system, now.pid, now.time_s, now.net_hash, "subsystem", "behaviour", "rate", "call",
                  "longest", "overruns", "errors");
  if (now.emergency)
    text = fmt::format("EMERGENCY STOP: {}\n`tessera reset` ends it\n\n{}", *now.emergency, text);
  for (std::size_t index = 0; index < now.subsystems.size() && index < before.subsystems.size(); ++index) {
    const Snapshot::Subsystem& one = now.subsystems[index];
    text += fmt::format("{:<28} {:<20} {:>18} {:>10} {:>10} {:>9} {:>7}\n", one.path, state_of(one),
                        rate_of(one, before.subsystems[index], elapsed_s), duration_of(one.call_s),
                        duration_of(one.longest_call_s), one.overruns, one.errors);
    text += overtime_of(one);
    text += memory_of(one);
  }
  text += fmt::format("\n{:<60} {}\n", "channel", "state");
  for (const Snapshot::Channel& channel : now.channels) {
    std::string marked;
    for (const std::string& place : channel.marked) marked += (marked.empty() ? "" : " + ") + place;
    text += fmt::format("{:<60} {}\n", channel.name, marked.empty() ? "in use" : marked);
  }
  return text;
}

/// Rates need some time between two states: the first two that a controller sends may come one after the other.
bool is_too_early(const Snapshot& now, const Snapshot& before, std::chrono::steady_clock::time_point since) {
  constexpr double shortest_s = 0.15;
  // The clock of the controller may stand still.
  return now.time_s - before.time_s < shortest_s &&
         std::chrono::steady_clock::now() - since < std::chrono::seconds(1);
}

int watch_one(SeenController& watched, const TopOptions& options) {
  if (!watched.snapshot) {
    complain(watched.controller.name() + " does not answer: " + hangs);
    if (options.once) return failed;
  }
  // 0: without limit
  watched.controller.be_patient_for(std::chrono::milliseconds(options.once ? 3000 : 0));
  std::optional<Snapshot> before;
  auto since = std::chrono::steady_clock::now();
  while (std::optional<project::ControlMessage> said = watched.controller.message()) {
    if (!said->content) return complain("the controller sent what this version does not understand");
    if (std::holds_alternative<ControllerHasEnded>(*said->content))
      return fmt::print("the controller has ended\n"), ok;
    auto* now = std::get_if<Snapshot>(&*said->content);
    if (now == nullptr) continue;
    if (options.lines) {
      fmt::print("{}\n", for_output(said->line));
      if (options.once) return ok;
    } else if (before) {
      if (is_too_early(*now, *before, since)) continue;
      const bool terminal = isatty(STDOUT_FILENO) != 0 && !options.once;
      fmt::print("{}{}", terminal ? "\033[H\033[2J" : "", printable(table(*now, *before)));
      if (options.once) return ok;
    }
    std::fflush(stdout);
    before = std::move(*now);
    since = std::chrono::steady_clock::now();
  }
  return complain(watched.controller.name() +
                  " sends nothing any more: it hangs, was killed, or has too many clients");
}

/// The specification that the options name, or that of this folder; nullopt: there is no such file.
std::optional<std::filesystem::path> named_specification(const TopOptions& options) {
  std::filesystem::path file = project::spec_file(options.which.empty() ? "." : options.which);
  std::error_code missing;
  if (!std::filesystem::is_regular_file(file, missing)) return std::nullopt;
  return file;
}

/// Whether the options say where the processes meet.
bool names_network(const project::NetworkOptions& network) {
  return !network.domain.empty() || !network.interface.empty() || !network.peers.empty();
}

/// Its processes may run on other machines only.
int watch_project(const std::filesystem::path& file, const TopOptions& options, const WatchOptions& how) {
  const std::optional<project::Specification> specification = project::read(file, terminal());
  if (!specification) return exit_code_without_net();
  const spec::Model& model = specification->model;
  if (!model.deployment) return complain_of_none(options.which);
  return watch_deployment(
      {.name = model.system,
       .found = 0,
       .given = project::meeting_place(*model.deployment, options.network, project::machine_name()),
       .firm = names_network(options.network)},
      how);
}

int top_command(const TopOptions& options) {
  const WatchOptions how{.once = options.once, .lines = options.lines};
  FoundControllers found = look_for_controllers(options.which);
  const std::size_t silent = found.silent.size();
  std::vector<SeenController> seen = first_look(std::move(found.running));
  if (seen.empty() || names_network(options.network)) {
    if (const std::optional<std::filesystem::path> file = named_specification(options))
      return watch_project(*file, options, how);
    if (names_network(options.network))
      return complain("--domain, --interface and --peers need a project with `deploy`: name it");
    return silent == 0 ? complain_of_none(options.which) : complain_of_silent(found.silent, hangs);
  }
  const std::optional<std::string> system = common_deployment(seen);
  const bool names_system = system && (options.which.empty() || options.which == *system);
  if (names_system || (system && seen.size() > 1))
    return watch_deployment({.name = *system, .found = seen.size() + silent, .given = {}, .firm = false},
                            how);
  const int others = complain_of_silent(found.silent, hangs);
  if (seen.size() > 1) return complain_of_several(seen);
  return std::max(watch_one(seen.front(), options), others);
}

}  // namespace

void add_top(CommandLine& app) {
  Subcommand command = app.add("top", "Watch a controller that runs in real time");
  TopOptions& options = command.runs(top_command);
  command.option(
      "controller,--controller", options.which,
      "Its system, its process (cart[0]) or its process number; needed if several systems run. A project: "
      "its processes on all machines");
  command.flag("--once", options.once, "Print one table (with --json: one line of each process) and end");
  command.flag("--json", options.lines, "Print the lines of JSON that the controllers send");
  command.option("--domain", options.network.domain,
                 "Of a project: domain of DDS (default: that of `deploy`)");
  command.option("--interface", options.network.interface,
                 "Of a project: network interface (default: that of `deploy`)");
  command.option("--peers", options.network.peers,
                 "Of a project: hosts of its processes: A,B (default: those of `deploy`)");
  command.footer(
      "A * behind a behaviour: its transition function is being executed. `call` is what its last one took,\n"
      "the lines below are its memory after that, `in use`: one side writes or reads the channel's memory. "
      "A\n"
      "system of several processes is shown as a whole, with those that wait for others for a second or\n"
      "more; name a process to see only that one, with its memory. One process of this machine is enough to "
      "see\n"
      "those of other machines. On a machine without one, name the project.\n"
      "Example: tessera run --world &  tessera top");
}

}  // namespace tessera::cli
