#include "cli/watching/top_deployment.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <variant>

#include "cli/terminal.hpp"
#include "cli/watching/deployment_table.hpp"
#include "project/files/installation.hpp"
#include "project/process/deployment_watch.hpp"
#include "tessera/monitor.hpp"
#include "tessera/printable.hpp"

namespace tessera::cli {

namespace {

using project::DeploymentWatch;
using project::WatchedProcess;
using Clock = DeploymentWatch::Clock;

/// Processes look for others every 4 s, and a packet of that may be lost.
constexpr std::chrono::milliseconds meets_within{5500};

ScreenSize screen_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 || size.ws_col == 0) return {};
  return {size.ws_row, size.ws_col};
}

bool any_is_there(const DeploymentWatch& deployment) {
  return std::ranges::any_of(deployment.processes(), [](const auto* one) { return one->is_there(); });
}

/// On a busy machine, a process that runs may need seconds for its first line.
constexpr std::chrono::milliseconds answers_within{5000};

/// Whether all processes of this machine were heard, and with `all` those of other machines, too. found: sockets
/// of this machine. silent_counts: so does a process that has not sent anything for a while.
bool has_heard(const DeploymentWatch& deployment, std::size_t found, bool silent_counts, bool all) {
  const auto here = std::ranges::count_if(deployment.processes(), [&](const auto* one) {
    if (one->by_network) return false;
    return silent_counts ? one->is_there() : one->state != WatchedProcess::State::silent;
  });
  if (here < static_cast<std::ptrdiff_t>(found)) return false;
  return !all || std::ranges::all_of(deployment.declared(), [&](const auto& declared) {
    const WatchedProcess* const one = deployment.find(declared.name);
    return one != nullptr && !one->snapshot.brief;
  });
}

/// Until each process has sent its state, or takes too long. With `once` it waits for other machines, too.
void wait_for_all(DeploymentWatch& deployment, const WatchedSystem& system, bool once,
                  const DeploymentWatch::EachLine& each_line) {
  const auto begin = Clock::now();
  for (;;) {
    const bool all = once && (deployment.watches_network() || (system.found == 0 && system.given));
    const std::chrono::milliseconds longest =
        all    ? meets_within
        : once ? answers_within
               : DeploymentWatch::longest_silence + std::chrono::milliseconds(200);
    if (has_heard(deployment, system.found, /*silent_counts=*/!once, all) || Clock::now() >= begin + longest)
      return;
    deployment.poll(std::chrono::milliseconds(100), each_line);
  }
}

/// The line of a process that sends none itself.
void print_state(const std::string& system, const std::string& process, const std::string& host,
                 const WatchedProcess* seen) {
  nlohmann::json line{
      {"system", system}, {"process", process}, {"state", seen ? name_of(seen->state) : "absent"}};
  if (seen != nullptr && seen->snapshot.pid >= 0) line["pid"] = seen->snapshot.pid;
  if (!host.empty()) line["host"] = host;
  fmt::print("{}\n", line.dump(-1, ' ', seen != nullptr && seen->by_network,
                               nlohmann::json::error_handler_t::replace));
}

/// A line for each process that was not heard, or is no longer.
void print_missing(const DeploymentWatch& deployment, const std::string& system) {
  if (!deployment.watches_network()) return;
  for (const Snapshot::Deployment::Process& one : deployment.declared()) {
    const WatchedProcess* const seen = deployment.find(one.name);
    if (seen == nullptr || seen->state != WatchedProcess::State::running)
      print_state(system, one.name, one.host, seen);
  }
}

int print_lines(DeploymentWatch& deployment, const WatchedSystem& system, bool once) {
  std::set<std::string> told;
  const auto each_line = [&](std::string_view line) {
    if (once) {
      const std::optional<ControlLine> read = read_control_line(line);
      const auto* snapshot = read ? std::get_if<Snapshot>(&*read) : nullptr;
      if (snapshot == nullptr || !told.insert(snapshot->process.value_or("")).second) return;
    }
    fmt::print("{}\n", for_output(line));
  };
  wait_for_all(deployment, system, once, each_line);
  if (once) {
    print_missing(deployment, system.name);
    if (const std::string remark = deployment.remark(); !remark.empty()) complain(remark);
    return told.empty() ? failed : ok;
  }
  std::map<std::string, WatchedProcess::State> states;  // by socket
  const auto patience = system.found == 0 ? meets_within : std::chrono::milliseconds(2000);
  for (auto last_seen = Clock::now(); Clock::now() < last_seen + patience;) {
    deployment.poll(std::chrono::milliseconds(200), each_line);
    for (const WatchedProcess* one : deployment.processes()) {
      if (one->is_there()) last_seen = Clock::now();
      const auto [known, is_new] = states.try_emplace(one->socket, WatchedProcess::State::running);
      if (known->second == one->state) continue;
      known->second = one->state;
      if (one->state != WatchedProcess::State::running)
        print_state(system.name, one->name(), one->snapshot.host, one);
    }
    std::fflush(stdout);
  }
  return ok;
}

std::string text_of_place(const Snapshot::Deployment& place) {
  std::string hosts;
  for (const std::string& peer : place.peers) hosts += (hosts.empty() ? "" : ", ") + peer;
  return fmt::format("domain {}, interface {}, hosts {}", place.domain,
                     place.interface.empty() ? "lo" : place.interface, hosts.empty() ? "-" : hosts);
}

int show_table(DeploymentWatch& deployment, const WatchedSystem& system, bool once) {
  wait_for_all(deployment, system, once, {});
  const bool terminal = isatty(STDOUT_FILENO) != 0 && !once;
  const auto patience = system.found == 0 ? meets_within : std::chrono::milliseconds(3000);
  bool any = false;
  auto shown = Clock::time_point::min(), last_seen = Clock::now();
  for (;;) {
    const auto now = Clock::now();
    if (any_is_there(deployment)) last_seen = now;
    any = any || !deployment.processes().empty();
    if (now - std::chrono::milliseconds(terminal ? 300 : 1000) >= shown && (any || terminal)) {
      const ScreenSize screen = once ? ScreenSize{} : screen_size();
      fmt::print("{}{}", terminal ? "\033[H\033[2J" : "",
                 printable(deployment_table(system.name, deployment, screen)));
      if (!terminal && !once) fmt::print("\n");
      std::fflush(stdout);
      shown = now;
      if (once) return ok;
    }
    // One that has failed may be started again.
    if (now - last_seen > patience || (once && !any)) break;
    deployment.poll(std::chrono::milliseconds(200));
  }
  if (any)
    return fmt::print("all processes of {} have ended, as far as they are seen here\n", system.name), ok;
  const std::string remark = deployment.remark();
  return complain(fmt::format("no process of {} is heard ({}){}", system.name,
                              system.given ? text_of_place(*system.given) : "on this machine",
                              remark.empty() ? "" : ": " + remark));
}

}  // namespace

int watch_deployment(const WatchedSystem& system, const WatchOptions& options) {
  DeploymentWatch deployment(monitor_folder(), system.name);
  deployment.watch_network(project::feed_of_library(project::Installation::find().carrier_library),
                           system.given, system.firm);
  return options.lines ? print_lines(deployment, system, options.once)
                       : show_table(deployment, system, options.once);
}

}  // namespace tessera::cli
