#include "cli/watching/deployment_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "project/process/waiting_chains.hpp"

namespace tessera::cli {

namespace {

using project::DeploymentWatch;
using project::WatchedProcess;

/// A line of the table. Lines without a problem are left out first.
struct TableLine {
  std::string text;
  bool in_order = false;
};

std::string seconds_text(double seconds) { return fmt::format("{:.1f} s", seconds); }

double age_of(WatchedProcess::Clock::time_point time) {
  return std::chrono::duration<double>(WatchedProcess::Clock::now() - time).count();
}

std::string state_text(const WatchedProcess& process) {
  switch (process.state) {
    case WatchedProcess::State::running:
      return process.snapshot.emergency ? "EMERGENCY STOP" : "running";
    case WatchedProcess::State::silent:
      return "SILENT " + seconds_text(age_of(process.heard));
    case WatchedProcess::State::ended:
      return "ended";
    case WatchedProcess::State::gone:
      return "GONE" + (process.since ? " " + seconds_text(age_of(*process.since)) : "");
  }
  return "";
}

/// "control: follow *, motor: drive"
std::string doings(const Snapshot& now) {
  std::string text;
  for (const Snapshot::Subsystem& one : now.subsystems) {
    const std::string doing = one.ended        ? "ended"
                              : !one.behaviour ? "-"
                                               : *one.behaviour + (one.calling ? " *" : "");
    text += (text.empty() ? "" : ", ") + one.path + ": " + doing;
  }
  return text;
}

/// Processes that are not seen, with their host and the reports of their neighbours.
std::vector<TableLine> unseen_lines(const DeploymentWatch& deployment, std::size_t width) {
  struct Known {
    std::string host, told;
    bool reachable = false;
  };
  std::map<std::string, Known> all;
  for (const Snapshot::Deployment::Process& one : deployment.declared())
    if (deployment.watches_network() && deployment.find(one.name) == nullptr) all[one.name].host = one.host;
  for (const WatchedProcess* one : deployment.processes())
    if (one->state == WatchedProcess::State::running)
      for (const Snapshot::Link& link : one->snapshot.links) {
        if (deployment.find(link.process) != nullptr) continue;
        Known& known = all[link.process];
        if (!known.told.empty()) continue;
        known = {link.host,
                 fmt::format(", {} from {}", link.reachable ? "reachable" : "NOT REACHABLE", one->name()),
                 link.reachable};
      }
  std::vector<TableLine> lines;
  for (const auto& [name, known] : all)
    lines.push_back({fmt::format("{:<{}}  {}{}{}", name, width,
                                 deployment.watches_network() ? "NOT HEARD" : "not on this machine",
                                 known.host.empty() ? "" : " (" + known.host + ")", known.told),
                     known.reachable && !deployment.watches_network()});
  return lines;
}

/// Hosts are named if there are several.
bool has_hosts(const DeploymentWatch& deployment) {
  std::set<std::string> hosts;
  for (const WatchedProcess* one : deployment.processes()) hosts.insert(one->snapshot.host);
  hosts.erase("");
  return hosts.size() > 1;
}

TableLine process_line(const WatchedProcess& one, std::size_t width, bool with_host) {
  const Snapshot& now = one.snapshot;
  std::uint64_t overruns = 0, errors = 0;
  for (const Snapshot::Subsystem& subsystem : now.subsystems) {
    overruns += subsystem.overruns;
    errors += subsystem.errors;
  }
  const bool runs = one.state == WatchedProcess::State::running;
  std::string doing = one.is_there() ? doings(now) : "";
  if (now.left_out > 0) doing += fmt::format(" ... and {} more", now.left_out);
  return {fmt::format("{:<{}}  {:<15} {:>8} {:>10} {:>8} {:>7}  {}{}", one.name(), width, state_text(one),
                      now.pid, now.net_hash.empty() ? "-" : seconds_text(now.time_s), overruns, errors,
                      with_host ? fmt::format("{:<15} ", now.host) : "", doing),
          runs && !now.emergency && errors == 0};
}

std::vector<TableLine> process_lines(const DeploymentWatch& deployment) {
  std::size_t width = 7;
  for (const WatchedProcess* one : deployment.processes()) width = std::max(width, one->name().size());
  for (const auto& one : deployment.declared()) width = std::max(width, one.name.size());
  const bool with_host = has_hosts(deployment);
  std::vector<TableLine> lines;
  lines.push_back({fmt::format("{:<{}}  {:<15} {:>8} {:>10} {:>8} {:>7}  {}{}", "process", width, "state",
                               "number", "time", "overruns", "errors",
                               with_host ? fmt::format("{:<15} ", "host") : "", "behaviours"),
                   false});
  for (const WatchedProcess* one : deployment.processes())
    lines.push_back(process_line(*one, width, with_host));
  for (TableLine& one : unseen_lines(deployment, width)) lines.push_back(std::move(one));
  return lines;
}

std::vector<TableLine> waiting_lines(const DeploymentWatch& deployment) {
  std::vector<TableLine> lines;
  for (const project::WaitingChain& chain : waiting_chains(deployment)) {
    std::string indent;
    // The end of the text matters most.
    const std::size_t left_out = chain.steps.size() > 6 ? chain.steps.size() - 4 : 0;
    for (std::size_t at = 0; at < chain.steps.size(); ++at) {
      if (left_out > 0 && at == 2) {
        lines.push_back({indent + fmt::format("... {} more in between", left_out), false});
        at += left_out;
      }
      lines.push_back({indent + chain.steps[at].text(), false});
      indent += "  ";
    }
    if (!chain.end.empty()) lines.push_back({indent + chain.end, false});
  }
  return lines;
}

/// "0.2 +- 0.1 ms"
std::string clock_text(const Snapshot::Link& link) {
  if (!link.clock_ahead_s) return "-";
  if (std::fabs(*link.clock_ahead_s) + link.clock_uncertainty_s < 1)
    return fmt::format("{:+.2f} +- {:.2f} ms", *link.clock_ahead_s * 1e3, link.clock_uncertainty_s * 1e3);
  return fmt::format("{:+.2f} +- {:.2f} s", *link.clock_ahead_s, link.clock_uncertainty_s);
}

std::vector<TableLine> link_lines(const DeploymentWatch& deployment) {
  std::vector<TableLine> lines;
  std::size_t width = 4;
  const auto name_of = [](const WatchedProcess& process, const Snapshot::Link& link) {
    return process.name() + " <- " + link.process;
  };
  for (const WatchedProcess* one : deployment.processes())
    for (const Snapshot::Link& link : one->snapshot.links)
      width = std::max(width, name_of(*one, link).size());
  const auto row = [&](const auto&... cells) {
    return fmt::format("{:<{}}  {:<22} {:>8} {:>7} {:>9} {:>9} {:>9} {:>10}  {}", cells...);
  };
  for (const WatchedProcess* one : deployment.processes()) {
    if (one->state != WatchedProcess::State::running) continue;  // what it knew is old
    const Snapshot& now = one->snapshot;
    for (const Snapshot::Link& link : now.links) {
      const std::string state =
          link.reachable ? "reachable" : "DISCONNECTED " + seconds_text(now.time_s - link.since_s);
      const double age = link.heard_s ? now.time_s - *link.heard_s : 0;
      const std::string loss = link.signs == 0
                                   ? "-"
                                   : fmt::format("{:.0f} %", 100.0 * static_cast<double>(link.signs_lost) /
                                                                 static_cast<double>(link.signs));
      lines.push_back({row(name_of(*one, link), width, state, link.heard_s ? seconds_text(age) : "never",
                           loss, link.sent, link.repeated, link.received, link.duplicates, clock_text(link)),
                       link.reachable && link.signs_lost == 0 && age < 1});
    }
  }
  if (!lines.empty())
    lines.insert(lines.begin(), {row("link", width, "state", "heard", "loss", "sent", "repeated", "received",
                                     "duplicates", "its clock is ahead by"),
                                 false});
  return lines;
}

/// At most `room` lines; those without a problem are dropped first, then the last ones.
void shorten(std::vector<TableLine>& lines, std::size_t room, const char* what) {
  if (lines.size() <= room) return;
  const std::size_t all = lines.size();
  for (auto at = lines.end(); lines.size() >= room && at != lines.begin();)
    if ((--at)->in_order) at = lines.erase(at);
  if (lines.size() >= room) lines.resize(std::max<std::size_t>(room, 1) - 1);
  lines.push_back({fmt::format("... and {} more {}", all - lines.size(), what), false});
}

}  // namespace

std::string deployment_table(const std::string& system, const DeploymentWatch& deployment,
                             ScreenSize screen) {
  const std::vector<const WatchedProcess*> all = deployment.processes();
  std::vector<TableLine> lines;
  std::map<std::string, std::string> emergencies;  // processes by reason
  std::set<std::string> nets;
  for (const WatchedProcess* one : all) {
    if (!one->snapshot.net_hash.empty()) nets.insert(one->snapshot.net_hash);
    if (!one->is_there() || !one->snapshot.emergency) continue;
    std::string& names = emergencies[*one->snapshot.emergency];
    names += (names.empty() ? "" : ", ") + one->name();
  }
  for (const auto& [why, names] : emergencies)
    lines.push_back({fmt::format("EMERGENCY STOP of {}: {}", names, why), false});
  if (!emergencies.empty()) lines.push_back({fmt::format("`tessera reset {}` ends it", system), false});
  const auto running = std::ranges::count(all, WatchedProcess::State::running, &WatchedProcess::state);
  lines.push_back(
      {fmt::format(
           "{}  {} of {} processes run  net {}{}", system, running,
           std::max(all.size(), deployment.watches_network() ? deployment.declared().size() : std::size_t{0}),
           nets.empty() ? "-" : *nets.begin(),
           nets.size() > 1 ? "  AND OTHERS: they do not work together" : ""),
       false});
  if (const std::string remark = deployment.remark(); !remark.empty())
    lines.push_back({"network: " + remark, false});
  std::vector<TableLine> waits = waiting_lines(deployment), processes = process_lines(deployment),
                         links = link_lines(deployment);
  const auto parts = {&waits, &processes, &links};
  std::size_t wanted = lines.size() + 1;
  for (const std::vector<TableLine>* part : parts) wanted += part->empty() ? 0 : part->size() + 1;
  if (wanted > screen.rows) {  // links first, then processes, then waits
    const std::size_t room = screen.rows > lines.size() + 4 ? screen.rows - lines.size() - 4 : 3;
    shorten(waits, std::max<std::size_t>(room / 3, 2), "lines of waits");
    const std::size_t for_processes = room - std::min(room, waits.size());
    const std::size_t least_links = std::min<std::size_t>(links.size(), for_processes / 3);
    shorten(processes, std::max<std::size_t>(for_processes - least_links, 2), "processes");
    const std::size_t left = room - std::min(room, waits.size() + processes.size());
    shorten(links, std::max<std::size_t>(left, 1), "links");
  }
  for (const std::vector<TableLine>* part : parts) {
    if (part->empty()) continue;
    lines.push_back({});
    lines.insert(lines.end(), part->begin(), part->end());
  }
  std::string text;
  for (const TableLine& line : lines) text += line.text.substr(0, screen.columns) + "\n";
  return text;
}

}  // namespace tessera::cli
