#include "cli/watching/not_reached.hpp"

#include "project/process/deployment_watch.hpp"

namespace tessera::cli {

void NotReached::reached(const Snapshot& snapshot) {
  if (!snapshot.process) return;
  tried_.insert(snapshot.system + "." + *snapshot.process);
  if (snapshot.deployment && !project::is_loopback(snapshot.deployment->interface))
    systems_.try_emplace(snapshot.system, *snapshot.deployment);
}

std::vector<std::string> NotReached::texts() const {
  std::vector<std::string> texts;
  for (const auto& [system, deployment] : systems_) {
    std::string names;
    for (const Snapshot::Deployment::Process& one : deployment.processes) {
      if (tried_.contains(system + "." + one.name)) continue;
      names += (names.empty() ? "" : ", ") + one.name + (one.host.empty() ? "" : " (" + one.host + ")");
    }
    if (!names.empty()) texts.push_back(system + ": " + names);
  }
  return texts;
}

}  // namespace tessera::cli
