#include "project/process/waiting_chains.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace tessera::project {

namespace {

using Seen = WatchedProcess::State;

double seconds_since(WatchedProcess::Clock::time_point time) {
  return std::chrono::duration<double>(WatchedProcess::Clock::now() - time).count();
}

/// The wait of one subsystem; among several waits, the earliest.
using Waits = std::map<std::string, WaitingStep>;

Waits waits_of(const DeploymentWatch& deployment, double least_s) {
  Waits all;
  for (const WatchedProcess* process : deployment.processes()) {
    if (process->state != Seen::running) continue;  // whatever it waited for: it is what others wait for
    const Snapshot& now = process->snapshot;
    for (const Snapshot::Wait& wait : now.waits) {
      const double for_s = now.time_s - wait.since_s;
      if (for_s < least_s) continue;
      const WaitingStep step{.subsystem = wait.subsystem,
                             .process = process->name(),
                             .waits_for = wait.waits_for,
                             .other_process = wait.process.empty() ? process->name() : wait.process,
                             .channel = wait.channel,
                             .for_answer = wait.for_answer,
                             .for_s = for_s};
      const auto [known, is_new] = all.try_emplace(wait.subsystem, step);
      if (!is_new && known->second.for_s < for_s) known->second = step;
    }
  }
  return all;
}

/// The waiting process's own knowledge of the other one.
const Snapshot::Link* link_of(const DeploymentWatch& deployment, const WaitingStep& step) {
  const WatchedProcess* waiting = deployment.find(step.process);
  if (waiting == nullptr) return nullptr;
  const auto& links = waiting->snapshot.links;
  const auto found = std::ranges::find(links, step.other_process, &Snapshot::Link::process);
  return found == links.end() ? nullptr : &*found;
}

/// The state of a process that is neither on this machine nor heard.
std::string unseen(const DeploymentWatch& deployment) {
  return deployment.watches_network() ? "is not heard here" : "is not on this machine";
}

std::string end_of(const DeploymentWatch& deployment, const WaitingStep& last) {
  const std::string& name = last.other_process;
  const Snapshot::Link* link = last.process == name ? nullptr : link_of(deployment, last);
  const WatchedProcess* other = deployment.find(name);
  if (other != nullptr && other->state == Seen::gone)
    return fmt::format("process {} is gone", name) +
           (other->since ? fmt::format(" for {:.1f} s", seconds_since(*other->since)) : "");
  if (other != nullptr && other->state == Seen::ended) return fmt::format("process {} has ended", name);
  if (other != nullptr && other->state == Seen::silent)
    return fmt::format("process {} has said nothing for {:.1f} s", name, seconds_since(other->heard));
  if (link != nullptr && !link->reachable)
    return fmt::format("process {} cannot be reached from {}{}", name, last.process,
                       other == nullptr ? ", and " + unseen(deployment) : "");
  if (other == nullptr) return fmt::format("process {} {}", name, unseen(deployment));
  const auto& all = other->snapshot.subsystems;
  const auto found = std::ranges::find(all, last.waits_for, &Snapshot::Subsystem::path);
  if (found == all.end()) return "";
  if (found->ended) return fmt::format("{} has ended", last.waits_for);
  if (!found->behaviour) return fmt::format("{} has not begun", last.waits_for);
  return fmt::format("{} is in {}{}", last.waits_for, *found->behaviour,
                     found->calling ? ", in its transition function" : "");
}

}  // namespace

std::string WaitingStep::text() const {
  return fmt::format("{} waits for {}: no {} for {:.1f} s", subsystem, waits_for,
                     for_answer ? "answer" : "value", for_s);
}

std::vector<WaitingChain> waiting_chains(const DeploymentWatch& deployment, double least_s) {
  const Waits waits = waits_of(deployment, least_s);
  std::set<std::string> waited_for, told;
  for (const auto& [subsystem, step] : waits) waited_for.insert(step.waits_for);
  std::vector<WaitingChain> chains;
  const auto follow = [&](const std::string& head) {
    WaitingChain chain;
    std::set<std::string> met;
    for (auto at = waits.find(head); at != waits.end(); at = waits.find(at->second.waits_for)) {
      if (!met.insert(at->first).second) {
        chain.end = "they wait for each other in a circle";
        break;
      }
      told.insert(at->first);
      chain.steps.push_back(at->second);
    }
    if (chain.end.empty()) chain.end = end_of(deployment, chain.steps.back());
    chains.push_back(std::move(chain));
  };
  for (const auto& [subsystem, step] : waits)
    if (!waited_for.contains(subsystem)) follow(subsystem);
  for (const auto& [subsystem, step] : waits)
    if (!told.contains(subsystem)) follow(subsystem);  // of a circle
  std::ranges::stable_sort(chains, [](const WaitingChain& one, const WaitingChain& other) {
    return one.steps.front().for_s > other.steps.front().for_s;
  });
  return chains;
}

}  // namespace tessera::project
