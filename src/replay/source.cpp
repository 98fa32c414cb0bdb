#include "replay/source.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <optional>
#include <utility>

namespace tessera::replay {

std::optional<Problem> Source::match(const net::Net& net,
                                     const std::unordered_map<std::string_view, std::uint32_t>& transitions) {
  if (std::optional<Problem> wrong = header_mismatch(recording_, net)) return wrong;
  for (const Recording::Transition& named : recording_.transitions)
    transitions_.push_back({transitions.at(named.name)});
  return std::nullopt;
}

std::string Source::path_of(const Event& event) const {
  return event.instance() == system_instance ? "the upper layers" : recording_.instances[event.instance()];
}

std::string Source::place_of(const Event& event) const {
  const std::string process = recording_.process ? recording_.process->name + ": " : "";
  return fmt::format("{}{:.6f} s: ", process, static_cast<double>(event.time_ns) * 1e-9);
}

std::string Source::twice(const Event& event) const {
  return fmt::format("{}an event of {} is there twice, or not in its place", place_of(event), path_of(event));
}

std::string Source::missing(const Event& event) const {
  return fmt::format("{}events of {} are missing", place_of(event), path_of(event));
}

std::optional<Problem> Source::stranger(const Event& event, const DeployedNet& net) const {
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

std::optional<std::uint64_t> incarnation_in(std::string_view text) {
  const std::size_t line = text.find('\n');
  if (line == std::string_view::npos) return std::nullopt;
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, problem] = std::from_chars(text.data() + line + 1, end, number);
  return problem == std::errc{} && rest == end && number != 0 ? std::optional(number) : std::nullopt;
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

}  // namespace tessera::replay
