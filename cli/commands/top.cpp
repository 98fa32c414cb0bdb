#include <fmt/core.h>
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands/commands.hpp"
#include "cli/running_controller.hpp"
#include "cli/terminal.hpp"

namespace tessera::cli {

namespace {

using nlohmann::json;

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
std::string rate_of(const json& now, const json& before, double elapsed_s) {
  const double done = now.at("iterations").get<double>() - before.at("iterations").get<double>();
  const double wanted = now.at("period_s").get<double>();
  const std::string kept = elapsed_s > 0 ? fmt::format("{:.1f}", done / elapsed_s) : "-";
  return wanted > 0 ? fmt::format("{} of {:.4g} Hz", kept, 1 / wanted) : kept + " Hz";
}

std::string state_of(const json& subsystem) {
  if (subsystem.at("ended").get<bool>()) return "ended";
  if (subsystem.at("behaviour").is_null()) return "-";
  return subsystem.at("behaviour").get<std::string>() + (subsystem.at("calling").get<bool>() ? " *" : "");
}

std::string table(const json& now, const json& before) {
  const double elapsed_s = now.at("time_s").get<double>() - before.at("time_s").get<double>();
  std::string text =
      fmt::format("{}  process {}  {:.1f} s  net {}\n\n{:<28} {:<20} {:>18} {:>10} {:>10} {:>9} {:>7}\n",
                  now.at("system").get<std::string>(), now.at("pid").get<int>(),
                  now.at("time_s").get<double>(), now.at("net_hash").get<std::string>(), "subsystem",
                  "behaviour", "rate", "call", "longest", "overruns", "errors");
  if (now.contains("emergency"))
    text = fmt::format("EMERGENCY STOP: {}\n`tessera reset` ends it\n\n{}",
                       now.at("emergency").get<std::string>(), text);
  for (std::size_t index = 0; index < now.at("subsystems").size(); ++index) {
    const json& one = now.at("subsystems")[index];
    text += fmt::format("{:<28} {:<20} {:>18} {:>10} {:>10} {:>9} {:>7}\n", one.at("path").get<std::string>(),
                        state_of(one), rate_of(one, before.at("subsystems")[index], elapsed_s),
                        duration_of(one.at("call_s").get<double>()),
                        duration_of(one.at("longest_call_s").get<double>()),
                        one.at("overruns").get<std::uint64_t>(), one.at("errors").get<std::uint64_t>());
  }
  text += fmt::format("\n{:<60} {}\n", "channel", "state");
  for (const json& channel : now.at("channels")) {
    std::string marked;
    for (const json& place : channel.at("marked"))
      marked += (marked.empty() ? "" : " + ") + place.get<std::string>();
    text +=
        fmt::format("{:<60} {}\n", channel.at("name").get<std::string>(), marked.empty() ? "in use" : marked);
  }
  return text;
}

int top_command(const TopOptions& options) {
  std::optional<RunningController> watched = find_controller(options.which);
  if (!watched) return failed;
  json before;
  while (const std::optional<std::string> line = watched->line()) {
    json now = json::parse(*line, nullptr, false);
    if (now.is_discarded()) return complain("the controller sent what this version does not understand");
    if (now.contains("ended")) break;
    if (options.lines) {
      fmt::print("{}\n", *line);
      if (options.once) return ok;
    } else if (!before.is_null()) {
      const bool terminal = isatty(STDOUT_FILENO) != 0 && !options.once;
      fmt::print("{}{}", terminal ? "\033[H\033[2J" : "", table(now, before));
      if (options.once) return ok;
    }
    std::fflush(stdout);
    before = std::move(now);
  }
  fmt::print("the controller has ended\n");
  return ok;
}

}  // namespace

void add_top(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("top", "Watch a controller that runs in real time");
  auto options = std::make_shared<TopOptions>();
  command.option("controller,--controller", options->which,
                 "Its system or its process; needed if several run");
  command.flag("--once", options->once, "Print one table and end");
  command.flag("--json", options->lines, "Print the lines of JSON that the controller sends");
  command.footer(
      "A * behind a behaviour: its transition function is being executed. `call` is what its last one took,\n"
      "`in use`: one side writes or reads the channel's memory.\n"
      "Example: tessera run --world &  tessera top");
  command.callback([options, &exit_code] { exit_code = top_command(*options); });
}

}  // namespace tessera::cli
