#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "diagnostics/source.hpp"
#include "net/pnml_reader.hpp"
#include "tessera/net_executor.hpp"
#include "tessera/printable.hpp"

namespace tessera::cli {

namespace {

using nlohmann::json;

struct PlayOptions {
  std::string file;  ///< PNML
  std::uint64_t steps = 1'000'000;
  std::uint64_t seed = 1;
  std::string json;  ///< file for the result; "-": standard output; empty: none
};

NetExecutor* playing = nullptr;
void stop_playing(int /*signal*/) { playing->stop(); }

/// During its lifetime, Ctrl-C ends the play and not the command.
class StopsOnInterrupt {
 public:
  explicit StopsOnInterrupt(NetExecutor& executor) {
    playing = &executor;
    before_ = std::signal(SIGINT, stop_playing);
  }
  ~StopsOnInterrupt() { std::signal(SIGINT, before_); }
  StopsOnInterrupt(const StopsOnInterrupt&) = delete;
  StopsOnInterrupt& operator=(const StopsOnInterrupt&) = delete;

 private:
  void (*before_)(int) = nullptr;
};

std::optional<net::Net> read_net(const std::string& file) {
  diagnostics::Diagnostics source = diagnostics::load(file);
  std::optional<net::Net> net;
  if (!source.has_errors()) net = net::read_pnml(source);
  terminal().say(source);
  return net;
}

ExecutableNet executable(const net::Net& net) {
  ExecutableNet result;
  const auto arcs = [](std::span<const net::Arc> given) {
    std::vector<ExecutableNet::Arc> ends;
    for (const net::Arc& arc : given) ends.push_back({arc.place.value, arc.weight});
    return ends;
  };
  for (const net::Place& place : net.places())
    result.places.push_back({.name = place.name, .tokens = place.tokens});
  for (std::uint32_t t = 0; t < net.transitions().size(); ++t)
    result.transitions.push_back({.name = net.transitions()[t].name,
                                  .inputs = arcs(net.preset({t})),
                                  .outputs = arcs(net.postset({t}))});
  return result;
}

struct Played {
  NetExecutor::Outcome outcome;
  double seconds = 0;
  std::vector<std::uint64_t> times;  ///< per transition
  std::vector<std::uint32_t> marking;
};

std::optional<Played> play(const net::Net& net, const PlayOptions& options) {
  Played played;
  played.times.resize(net.transitions().size());
  std::string error;
  const auto executor =
      NetExecutor::load(executable(net),
                        {.ties = NetExecutor::Ties::random,
                         .seed = options.seed,
                         .on_firing = [&](std::uint32_t transition) { ++played.times[transition]; }},
                        error);
  if (executor == nullptr) {
    complain(error);
    return std::nullopt;
  }
  const StopsOnInterrupt interruptible(*executor);
  const auto start = std::chrono::steady_clock::now();
  played.outcome = executor->run(options.steps);
  played.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  played.marking = executor->marking();
  return played;
}

std::string ending(const NetExecutor::Outcome& outcome) {
  switch (outcome.end) {
    case NetExecutor::End::limit:
      return "steps";
    case NetExecutor::End::stopped:
      return "stopped";
    case NetExecutor::End::fault:
      return outcome.fault;
    case NetExecutor::End::dead:
    case NetExecutor::End::blocked:
      break;
  }
  return "dead";
}

/// JSON: {"firings", "seconds", "ended": "steps" | "dead" | "stopped" | the error, "fired": {transition:
/// times}, "marking": {place: tokens}}. The two maps leave out zeros.
json to_json(const net::Net& net, const Played& played) {
  json fired = json::object(), marking = json::object();
  for (std::size_t t = 0; t < played.times.size(); ++t)
    if (played.times[t] > 0) fired[net.transitions()[t].name] = played.times[t];
  for (std::size_t p = 0; p < played.marking.size(); ++p)
    if (played.marking[p] > 0) marking[net.places()[p].name] = played.marking[p];
  return {{"firings", played.outcome.firings},
          {"seconds", played.seconds},
          {"ended", ending(played.outcome)},
          {"fired", fired},
          {"marking", marking}};
}

void print(const net::Net& net, const Played& played) {
  constexpr std::size_t shown = 20;
  const double rate = static_cast<double>(played.outcome.firings) / std::max(played.seconds, 1e-9);
  fmt::print("{} firings in {:.3f} s, {:.1f} million a second; ended: {}\n", played.outcome.firings,
             played.seconds, rate * 1e-6, printable(ending(played.outcome)));
  std::vector<std::uint32_t> order(played.times.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, std::greater<>(), [&](std::uint32_t t) { return played.times[t]; });
  for (std::size_t i = 0; i < std::min(shown, order.size()); ++i)
    fmt::print("{:12} {}\n", played.times[order[i]], printable(net.transitions()[order[i]].name));
  if (order.size() > shown)
    fmt::print("{:>12} {} transitions more, all of them with --json FILE\n", "...", order.size() - shown);
  const auto never = std::ranges::count(played.times, std::uint64_t{0});
  if (never > 0) fmt::print("{} of {} transitions never fired\n", never, played.times.size());
}

/// Fires randomly chosen enabled transitions until the steps are used up, no transition is enabled, or Ctrl-C.
int play_command(const PlayOptions& options) {
  const std::optional<net::Net> net = read_net(options.file);
  if (!net) return exit_code_without_net();
  const std::optional<Played> played = play(*net, options);
  if (!played) return failed;
  if (options.json != "-") print(*net, *played);
  if (!options.json.empty()) write_output(options.json, to_json(*net, *played).dump(2) + "\n");
  switch (played->outcome.end) {
    case NetExecutor::End::fault:
      return failed;
    case NetExecutor::End::stopped:
      return interrupted;
    default:
      return ok;
  }
}

}  // namespace

void add_play(CommandLine& app) {
  Subcommand command = app.add("play", "Fire the transitions of a net that has no controller (PNML)");
  PlayOptions& options = command.runs(play_command);
  command.option("net", options.file, "PNML file").required();
  command.option("steps", options.steps, "How often to fire").shows_default();
  command.option("--seed", options.seed, "Seed of the lots that decide ties").shows_default();
  command.option("--json", options.json, "Write the outcome as JSON (- is standard output)");
  command.footer("Example: tessera play net.pnml 1000000 --seed 7");
}

}  // namespace tessera::cli
