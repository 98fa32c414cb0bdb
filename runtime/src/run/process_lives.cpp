#include "run/process_lives.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "system/console.hpp"

namespace tessera {
namespace {

[[nodiscard]] std::vector<std::uint32_t> instances_of(const Assembly& assembly, std::uint32_t process) {
  std::vector<std::uint32_t> instances;
  for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance)
    if (assembly.system.process_of[instance] == process) instances.push_back(instance);
  return instances;
}

/// The agents of these subsystems, each once.
[[nodiscard]] std::vector<std::uint32_t> agents_of(const UpperLayers& upper,
                                                   const std::vector<std::uint32_t>& instances) {
  std::vector<std::uint32_t> agents;
  for (const std::uint32_t instance : instances)
    if (agents.empty() || agents.back() != upper.agent_of(instance))
      agents.push_back(upper.agent_of(instance));
  return agents;
}

}  // namespace

Time ProcessLives::next(const Assembly& assembly) const {
  Time next = deaths_ < assembly.outages.size() ? assembly.outages[deaths_].from : Time::max();
  for (const Start& start : starts_) next = std::min(next, start.at);
  return next;
}

std::optional<ProcessLives::Change> ProcessLives::follow(Assembly& assembly, UpperLayers& upper, Time now,
                                                         std::string& error) {
  started_.resize(assembly.part.whole->processes.size());
  const auto start = std::ranges::find_if(starts_, [&](const Start& one) { return one.at <= now; });
  if (start != starts_.end()) {
    const std::uint32_t process = start->process;
    starts_.erase(start);
    return begin(assembly, upper, process, now, error);
  }
  if (deaths_ == assembly.outages.size() || assembly.outages[deaths_].from > now) return std::nullopt;
  return die(assembly, upper, assembly.outages[deaths_++], now);
}

ProcessLives::Change ProcessLives::die(Assembly& assembly, UpperLayers& upper, const Outage& outage,
                                       Time now) {
  Change change{.died = true, .instances = instances_of(assembly, outage.process)};
  for (const std::uint32_t agent : agents_of(upper, change.instances)) upper.agent_died(agent);
  assembly.restarts->kill(outage.process);
  for (const std::uint32_t instance : change.instances) assembly.control.mark_ended(instance);
  tell(assembly, outage.process, /*begins=*/false, now);
  for (const std::uint32_t instance : change.instances)
    assembly.executors[instance]->operations().present().end(now);
  for (const std::uint32_t instance : change.instances) assembly.executors[instance]->leave();
  for (const std::uint32_t instance : change.instances) assembly.executors[instance]->insist();
  if (outage.until != Time::max()) starts_.push_back({outage.process, outage.until});
  return change;
}

std::optional<ProcessLives::Change> ProcessLives::begin(Assembly& assembly, UpperLayers& upper,
                                                        std::uint32_t process, Time now, std::string& error) {
  Change change{.instances = instances_of(assembly, process)};
  for (const std::uint32_t instance : change.instances)
    for (const std::string& wrong : assembly.executors[instance]->operations().devices().close())
      console::print(LogLevel::warning, now, "tessera", wrong);
  ++started_[process];
  if (!assembly.restarts->restart(process, incarnation(assembly, process), error)) return std::nullopt;
  tell(assembly, process, /*begins=*/true, now);
  for (const std::uint32_t agent : agents_of(upper, change.instances)) upper.agent_begins_again(agent, now);
  for (const std::uint32_t instance : change.instances) assembly.executors[instance]->enter();
  return change;
}

network::Incarnation ProcessLives::incarnation(const Assembly& assembly, std::uint32_t process) const {
  return {assembly.incarnation.value + started_[process]};
}

void ProcessLives::tell(Assembly& assembly, std::uint32_t process, bool begins, Time now) const {
  const std::string_view name = assembly.part.whole->processes[process].name;
  const std::uint64_t number = incarnation(assembly, process).value;
  console::print(LogLevel::warning, now, name,
                 begins ? fmt::format("injected: the process begins again (start {})", number)
                        : fmt::format("injected: the process dies (start {})", number));
  if (assembly.recorder != nullptr)
    assembly.recorder->system_lane()->text(Event::Kind::process, now, begins ? 1 : 0,
                                           fmt::format("{}\n{}", name, number));
}

std::uint64_t ProcessLives::past_firings(const Assembly& assembly) {
  std::uint64_t firings = 0;
  for (const auto& executor : assembly.dead) firings += executor->firings();
  return firings;
}

}  // namespace tessera
