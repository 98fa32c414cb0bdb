#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/commands/deployment_table.hpp"
#include "cli/running_controller.hpp"
#include "cli/terminal.hpp"
#include "project/process/control_messages.hpp"
#include "project/process/deployment_watch.hpp"
#include "tessera/monitor.hpp"
#include "tessera/printable.hpp"

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

/// The table and the details of one controller.
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

ScreenSize screen_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 || size.ws_col == 0) return {};
  return {size.ws_row, size.ws_col};
}

int watch_one(SeenController& watched, const TopOptions& options) {
  watched.controller.be_patient_for(std::chrono::milliseconds(0));  // without limit
  std::optional<Snapshot> before;
  std::optional<std::string> said =
      watched.line.empty() ? watched.controller.line() : std::optional(std::move(watched.line));
  for (; said; said = watched.controller.line()) {
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
      fmt::print("{}{}", terminal ? "\033[H\033[2J" : "", printable(table(*now, *before)));
      if (options.once) return ok;
    }
    std::fflush(stdout);
    before = std::move(*now);
  }
  fmt::print("the controller has ended\n");
  return ok;
}

using Clock = project::DeploymentWatch::Clock;

/// Waits until each process that was found has sent its state, or takes too long.
void wait_for_all(project::DeploymentWatch& deployment, std::size_t found,
                  const project::DeploymentWatch::EachLine& each_line) {
  const auto end = Clock::now() + project::DeploymentWatch::longest_silence + std::chrono::milliseconds(200);
  while (std::ranges::count_if(deployment.processes(), [](const auto* one) { return one->is_there(); }) <
             static_cast<std::ptrdiff_t>(found) &&
         Clock::now() < end)
    deployment.poll(std::chrono::milliseconds(100), each_line);
}

int print_lines(project::DeploymentWatch& deployment, std::size_t found, bool once) {
  std::set<std::string> told;
  const auto each_line = [&](std::string_view line) {
    if (once) {
      const std::optional<project::ControlLine> read = project::read_control_line(line);
      const auto* snapshot = read ? std::get_if<Snapshot>(&*read) : nullptr;
      if (snapshot == nullptr || !told.insert(snapshot->name.value_or("")).second) return;
    }
    fmt::print("{}\n", line);
  };
  const auto tell_of_gone = [](const project::WatchedProcess& process) {
    nlohmann::json line{{"system", process.snapshot.system},
                        {"process", process.name()},
                        {"pid", process.snapshot.process},
                        {"state", name_of(process.state)}};
    fmt::print("{}\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  };
  wait_for_all(deployment, found, each_line);
  std::set<std::string> gone;  // sockets
  for (auto last_seen = Clock::now(); !once && Clock::now() < last_seen + std::chrono::seconds(2);) {
    deployment.poll(std::chrono::milliseconds(200), each_line);
    for (const project::WatchedProcess* one : deployment.processes()) {
      if (one->is_there())
        last_seen = Clock::now();
      else if (gone.insert(one->socket).second)
        tell_of_gone(*one);
    }
    std::fflush(stdout);
  }
  return ok;
}

int watch_deployment(const std::string& system, std::size_t found, const TopOptions& options) {
  project::DeploymentWatch deployment(monitor_folder(), system);
  if (options.lines) return print_lines(deployment, found, options.once);
  wait_for_all(deployment, found, {});
  const bool terminal = isatty(STDOUT_FILENO) != 0 && !options.once;
  auto shown = Clock::time_point::min(), last_seen = Clock::now();
  for (;;) {
    const auto now = Clock::now();
    if (std::ranges::any_of(deployment.processes(), [](const auto* one) { return one->is_there(); }))
      last_seen = now;
    if (now - std::chrono::milliseconds(terminal ? 300 : 1000) >= shown) {
      const ScreenSize screen = options.once ? ScreenSize{} : screen_size();
      fmt::print("{}{}", terminal ? "\033[H\033[2J" : "",
                 printable(deployment_table(system, deployment, screen)));
      if (!terminal && !options.once) fmt::print("\n");
      std::fflush(stdout);
      shown = now;
      if (options.once) return ok;
    }
    // A process that has failed may be started again.
    if (now - last_seen > std::chrono::seconds(3)) break;
    deployment.poll(std::chrono::milliseconds(200));
  }
  fmt::print("all processes of {} on this machine have ended\n", system);
  return ok;
}

int top_command(const TopOptions& options) {
  std::vector<SeenController> seen = first_look(find_controllers(options.which));
  if (seen.empty()) return failed;
  const std::optional<std::string> system = common_deployment(seen);
  const bool names_system = system && (options.which.empty() || options.which == *system);
  if (names_system || (system && seen.size() > 1)) return watch_deployment(*system, seen.size(), options);
  if (seen.size() > 1) return complain_of_several(seen);
  return watch_one(seen.front(), options);
}

}  // namespace

void add_top(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("top", "Watch a controller that runs in real time");
  auto options = std::make_shared<TopOptions>();
  command.option("controller,--controller", options->which,
                 "Its system, its process (cart[0]) or its process number; needed if several systems run");
  command.flag("--once", options->once, "Print one table (with --json: one line of each process) and end");
  command.flag("--json", options->lines, "Print the lines of JSON that the controllers send");
  command.footer(
      "A * behind a behaviour: its transition function is being executed. `call` is what its last one took,\n"
      "the lines below are its memory after that, `in use`: one side writes or reads the channel's memory. "
      "A\n"
      "system of several processes is shown as a whole, with those that wait for others for a second or\n"
      "more; name a process to see only that one, with its memory.\n"
      "Example: tessera run --world &  tessera top");
  command.callback([options, &exit_code] { exit_code = top_command(*options); });
}

}  // namespace tessera::cli
