#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "cli/commands/commands.hpp"
#include "cli/running_controller.hpp"
#include "cli/terminal.hpp"
#include "project/process/control_messages.hpp"

namespace tessera::cli {

namespace {

using project::Snapshot;

struct TopOptions {
  std::string which;
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

/// Both of one controller.
std::string table(const Snapshot& now, const Snapshot& before) {
  const double elapsed_s = now.time_s - before.time_s;
  std::string text =
      fmt::format("{}  process {}  {:.1f} s  net {}\n\n{:<28} {:<20} {:>18} {:>10} {:>10} {:>9} {:>7}\n",
                  now.system, now.process, now.time_s, now.net_hash, "subsystem", "behaviour", "rate", "call",
                  "longest", "overruns", "errors");
  if (now.emergency)
    text = fmt::format("EMERGENCY STOP: {}\n`tessera reset` ends it\n\n{}", *now.emergency, text);
  for (std::size_t index = 0; index < now.subsystems.size() && index < before.subsystems.size(); ++index) {
    const Snapshot::Subsystem& one = now.subsystems[index];
    text += fmt::format("{:<28} {:<20} {:>18} {:>10} {:>10} {:>9} {:>7}\n", one.path, state_of(one),
                        rate_of(one, before.subsystems[index], elapsed_s), duration_of(one.call_s),
                        duration_of(one.longest_call_s), one.overruns, one.errors);
  }
  text += fmt::format("\n{:<60} {}\n", "channel", "state");
  for (const Snapshot::Channel& channel : now.channels) {
    std::string marked;
    for (const std::string& place : channel.marked) marked += (marked.empty() ? "" : " + ") + place;
    text += fmt::format("{:<60} {}\n", channel.name, marked.empty() ? "in use" : marked);
  }
  return text;
}

int top_command(const TopOptions& options) {
  std::optional<RunningController> watched = find_controller(options.which);
  if (!watched) return failed;
  std::optional<Snapshot> before;
  while (const std::optional<std::string> said = watched->line()) {
    std::optional<project::ControlLine> line = project::read_control_line(*said);
    if (!line) return complain("the controller sent what this version does not understand");
    if (std::holds_alternative<project::ControllerHasEnded>(*line)) break;
    auto* now = std::get_if<Snapshot>(&*line);
    if (now == nullptr) continue;
    if (options.lines) {
      fmt::print("{}\n", *said);
      if (options.once) return ok;
    } else if (before) {
      const bool terminal = isatty(STDOUT_FILENO) != 0 && !options.once;
      fmt::print("{}{}", terminal ? "\033[H\033[2J" : "", table(*now, *before));
      if (options.once) return ok;
    }
    std::fflush(stdout);
    before = std::move(*now);
  }
  fmt::print("the controller has ended\n");
  return ok;
}

}  // namespace

void add_top(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("top", "Watch a controller that runs in real time");
  auto options = std::make_shared<TopOptions>();
  command.option("controller,--controller", options->which,
                 "Its system, its process (cart[0]) or its process number; needed if several run");
  command.flag("--once", options->once, "Print one table and end");
  command.flag("--json", options->lines, "Print the lines of JSON that the controller sends");
  command.footer(
      "A * behind a behaviour: its transition function is being executed. `call` is what its last one took,\n"
      "`in use`: one side writes or reads the channel's memory.\n"
      "Example: tessera run --world &  tessera top");
  command.callback([options, &exit_code] { exit_code = top_command(*options); });
}

}  // namespace tessera::cli
