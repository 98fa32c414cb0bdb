#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>

#include "replay/coverage.hpp"

namespace tessera::replay {
namespace {

using Group = Coverage::Group;
using Missing = Coverage::Missing;
using Share = Coverage::Share;
using nlohmann::ordered_json;

/// The JSON has all.
constexpr std::size_t most_groups = 60, most_missing = 8;

std::string total(const char* what, const Share& share) {
  return fmt::format("  {:<12} {:>6} of {:>6}  {:>5.1f} %\n", what, share.reached, share.all,
                     100 * share.share());
}

/// The name within its group.
std::string_view local(const Missing& missing, const Group& group) {
  std::string_view name = missing.name;
  if (name.starts_with(group.path) && name.size() > group.path.size() && name[group.path.size()] == '.')
    name.remove_prefix(group.path.size() + 1);
  return name;
}

/// The lines of a specification, with the name of its file.
struct Lines {
  const diagnostics::Sources& sources;
  const std::string& file;
};

std::string line_text(const net::Span& span, const Lines& lines) {
  if (span.line == 0) return "";
  const diagnostics::SourceLine place = lines.sources.at(span.line);
  const std::filesystem::path beside = std::filesystem::path(lines.file).parent_path();
  return fmt::format("   {}:{}", place.file.empty() ? lines.file : (beside / place.file).string(),
                     place.line);
}

void add_line(ordered_json& to, const net::Span& span, const diagnostics::Sources& sources) {
  to["line"] = sources.own_line(span.line);
  if (const std::string included = sources.included_line(span.line); !included.empty())
    to["included"] = included;
}

std::string describe(const Missing& missing, const Group& group, const Lines& lines) {
  const std::string_view name = local(missing, group);
  const std::string condition = missing.text.empty() ? "" : fmt::format(" [{}]", missing.text);
  switch (missing.kind) {
    case Missing::Kind::place:
      return fmt::format("    never marked: {}{}\n", name, line_text(missing.span, lines));
    case Missing::Kind::transition:
      return fmt::format("    never fired: {}{}{}\n", name, condition, line_text(missing.span, lines));
    case Missing::Kind::holds:
      return fmt::format("    never true: {}{}{}\n", name, condition, line_text(missing.span, lines));
    case Missing::Kind::does_not_hold:
      return fmt::format("    never false: {}{}{}\n", name, condition, line_text(missing.span, lines));
  }
  return "";
}

const char* name_of(Group::Kind kind) {
  constexpr const char* names[] = {"system", "agent", "subsystem", "behaviour", "channels"};
  return names[static_cast<std::size_t>(kind)];
}

const char* name_of(Missing::Kind kind) {
  constexpr const char* names[] = {"place", "transition", "holds", "does_not_hold"};
  return names[static_cast<std::size_t>(kind)];
}

std::string text_of(const Group& group, const Lines& lines) {
  std::string text =
      fmt::format("\n{}{}\n", group.path.empty() ? "the system" : group.path, line_text(group.span, lines));
  if (group.kind == Group::Kind::behaviour && !group.reached) return text + "    never entered\n";
  // A condition that never held says more than its transition, which never fired.
  std::size_t shown = 0, left = 0;
  for (const Missing& missing : group.missing) {
    const bool said = missing.kind == Missing::Kind::transition &&
                      std::ranges::any_of(group.missing, [&](const Missing& other) {
                        return other.kind == Missing::Kind::holds && other.name == missing.name;
                      });
    if (said) continue;
    if (shown++ < most_missing)
      text += describe(missing, group, lines);
    else
      ++left;
  }
  if (left > 0) text += fmt::format("    ... and {} more\n", left);
  return text;
}

ordered_json to_json(const Share& share) { return {{"reached", share.reached}, {"all", share.all}}; }

ordered_json to_json(const Group& group, const diagnostics::Sources& sources) {
  ordered_json missing = ordered_json::array();
  for (const Missing& one : group.missing) {
    missing.push_back({{"kind", name_of(one.kind)}, {"name", one.name}, {"text", one.text}});
    add_line(missing.back(), one.span, sources);
  }
  ordered_json json{{"path", group.path}, {"kind", name_of(group.kind)}};
  add_line(json, group.span, sources);
  json["reached"] = group.reached;
  json["places"] = to_json(group.places);
  json["transitions"] = to_json(group.transitions);
  json["conditions"] = to_json(group.conditions);
  json["missing"] = std::move(missing);
  return json;
}

}  // namespace

std::string coverage_text(const Coverage& coverage, const std::string& file,
                          const diagnostics::Sources& sources) {
  std::string text =
      fmt::format("coverage of the net by {} run{}:\n", coverage.runs, coverage.runs == 1 ? "" : "s");
  text += total("behaviours", coverage.behaviours);
  text += total("places", coverage.places);
  text += total("transitions", coverage.transitions);
  text += total("conditions", coverage.conditions);
  if (coverage.unreachable > 0)
    text += fmt::format("  ({} places and transitions are left out: no run can reach them)\n",
                        coverage.unreachable);
  if (coverage.lacks_events)
    text += "  (events are missing in a recording: what is named below may have been reached)\n";
  std::size_t shown = 0, left = 0;
  for (const Group& group : coverage.groups) {
    if (group.missing.empty()) continue;
    if (shown++ < most_groups)
      text += text_of(group, {sources, file});
    else
      ++left;
  }
  if (left > 0) text += fmt::format("\n... and {} more, which --coverage=FILE has\n", left);
  return text;
}

std::string coverage_json(const Coverage& coverage, const net::Net& net, const FiringCounts& counts) {
  ordered_json groups = ordered_json::array(), firings = ordered_json::object();
  for (const Group& group : coverage.groups) groups.push_back(to_json(group, net.parts().sources));
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    firings[net.transitions()[index].name] = counts.of(net::TransitionId{index});
  const ordered_json json{{"runs", coverage.runs},
                          {"lacks_events", coverage.lacks_events},
                          {"unreachable", coverage.unreachable},
                          {"behaviours", to_json(coverage.behaviours)},
                          {"places", to_json(coverage.places)},
                          {"transitions", to_json(coverage.transitions)},
                          {"conditions", to_json(coverage.conditions)},
                          {"groups", std::move(groups)},
                          {"firings", std::move(firings)}};
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace tessera::replay
