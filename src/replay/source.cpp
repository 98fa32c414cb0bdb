#include "replay/joint_source.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "replay/joint_legality.hpp"
#include "replay/net_play.hpp"

namespace tessera::replay {

std::optional<Problem> JointSource::match(
    const net::Net& net, const std::unordered_map<std::string_view, std::uint32_t>& transitions) {
  if (std::optional<Problem> wrong = header_mismatch(recording_, net)) return wrong;
  for (const Recording::Transition& named : recording_.transitions)
    transitions_.push_back({transitions.at(named.name)});
  return std::nullopt;
}

std::string JointSource::path_of(const Event& event) const {
  return event.instance() == system_instance ? "the upper layers" : recording_.instances[event.instance()];
}

std::string JointSource::place_of(const Event& event) const {
  const std::string process = recording_.process ? recording_.process->name + ": " : "";
  return process + seconds_text(event.time_ns) + ": ";
}

std::string JointSource::twice(const Event& event) const {
  return fmt::format("{}an event of {} is there twice, or not in its place", place_of(event), path_of(event));
}

std::string JointSource::missing(const Event& event) const {
  return fmt::format("{}events of {} are missing", place_of(event), path_of(event));
}

std::optional<Problem> JointSource::stranger(const Event& event, const DeployedNet& net) const {
  if (event.kind() != Event::Kind::firing) return std::nullopt;
  const net::TransitionId id = transition(event);
  const char* whose = nullptr;
  if (recording_.transitions[event.subject].instance != event.instance())
    whose = "subsystem";
  else if (recording_.process && net[id].process.value != recording_.process->number)
    whose = "process";
  if (whose == nullptr) return std::nullopt;
  return Problem{fmt::format("{}'{}' fired, which is no transition of this {}", place_of(event),
                             net.net()[id].name, whose)};
}

std::string names_without(const ProcessMap& processes, const std::vector<bool>& given) {
  constexpr std::size_t named = 4;
  std::string names;
  std::size_t count = 0;
  for (std::size_t process = 0; process < given.size(); ++process)
    if (!given[process] && ++count <= named) names += (names.empty() ? "" : ", ") + processes.names[process];
  return count > named ? fmt::format("{} and {} more processes", names, count - named) : names;
}

std::vector<const Recording*> in_order(std::span<const Recording> recordings) {
  std::vector<const Recording*> sorted;
  for (const Recording& recording : recordings) sorted.push_back(&recording);
  const auto key = [](const Recording* recording) {
    return recording->process ? std::pair(recording->process->number, recording->process->incarnation)
                              : std::pair(std::uint32_t{0}, std::uint64_t{0});
  };
  std::ranges::stable_sort(sorted, std::less{}, key);
  return sorted;
}

bool is_of_deployed(const Recording& recording) {
  return recording.process.has_value() || !recording.processes.empty();
}

std::optional<std::string> cannot_be_joined(std::span<const Recording> recordings,
                                            const ProcessMap& processes) {
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::size_t> seen;
  for (const Recording& recording : recordings) {
    if (!recording.process && recordings.size() > 1)
      return "one of them is of a whole system, which is judged alone; give recordings of processes only";
    if (recording.processes != processes.names)
      return "the recording is of other processes than those that the specification deploys";
    if (!recording.process) continue;
    const Recording::OneProcess& own = *recording.process;
    if (own.number >= processes.names.size() || processes.names[own.number] != own.name)
      return fmt::format("the specification deploys no process '{}' with number {}", own.name, own.number);
    if (++seen[{own.number, own.incarnation}] > 1)
      return fmt::format("two of them are of '{}' in the same start (incarnation {}); give one", own.name,
                         own.incarnation);
  }
  return std::nullopt;
}

}  // namespace tessera::replay
