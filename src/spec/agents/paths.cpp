#include "spec/agents/paths.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* path_hint = "a buffer is named AGENT.SUBSYSTEM.BUFFER, for example robot.control.line";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

std::optional<Selector> read_index(std::string_view text) {
  text = without_blanks(text);
  if (text == "*") return Selector{Selector::Kind::all, 0};
  if (text == "i") return Selector{Selector::Kind::variable, 0};
  if (text.starts_with('i')) {
    const std::string_view rest = without_blanks(text.substr(1));
    if (!rest.starts_with('+') && !rest.starts_with('-')) return std::nullopt;
    const auto offset = whole_number(without_blanks(rest.substr(1)));
    if (!offset || *offset < 0) return std::nullopt;
    return Selector{Selector::Kind::variable, rest.front() == '-' ? -*offset : *offset};
  }
  const auto number = whole_number(text);
  if (!number) return std::nullopt;
  return Selector{Selector::Kind::constant, *number};
}

std::optional<std::uint32_t> agent_number(const Selector& selector, const AgentGroup& group, std::int64_t i) {
  if (selector.kind == Selector::Kind::plain) return 0;
  if (selector.kind == Selector::Kind::constant) return static_cast<std::uint32_t>(selector.number);
  const std::int64_t count = group.count;
  std::int64_t number = selector.kind == Selector::Kind::all ? i : i + selector.number;
  if (group.ring) number = ((number % count) + count) % count;
  if (number < 0 || number >= count) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

namespace {

std::optional<BufferPath> split(const Node& text, std::size_t offset, std::size_t length, bool needs_buffer,
                                Diagnostics& out) {
  const std::string_view all = std::string_view(text.text).substr(offset, length);
  const auto span = [&](std::string_view part) {
    return text.part(static_cast<std::size_t>(part.data() - text.text.data()),
                     std::max<std::size_t>(part.size(), 1));
  };
  const auto fail = [&](std::string_view at, const std::string& message, const char* hint) {
    out.error("E112", span(at), message, hint);
    return std::nullopt;
  };
  BufferPath path;
  path.whole = span(all);
  const std::size_t bracket = all.find('[');
  const std::size_t agent_end = std::min(bracket, all.find('.'));
  const std::string_view agent = all.substr(0, agent_end);
  std::string_view rest = agent_end == std::string_view::npos ? std::string_view() : all.substr(agent_end);
  if (rest.starts_with('[')) {
    const std::size_t close = rest.find(']');
    if (close == std::string_view::npos) return fail(rest.substr(0, 1), "'[' is not closed", index_hint);
    const std::string_view index = rest.substr(1, close - 1);
    const auto selector = read_index(index);
    path.index_span = span(index);
    if (!selector) return fail(index, in_quotes(index) + " is not an index", index_hint);
    path.selector = *selector;
    rest.remove_prefix(close + 1);
  }
  const std::size_t dot = rest.empty() ? std::string_view::npos : rest.find('.', 1);
  const bool has_buffer = dot != std::string_view::npos;
  if (!rest.starts_with('.') || (needs_buffer && !has_buffer)) {
    return fail(all, in_quotes(all) + " does not name a buffer", path_hint);
  }
  const std::string_view subsystem = rest.substr(1, dot - 1);
  std::string_view buffer = has_buffer ? rest.substr(dot + 1) : rest.substr(rest.size());
  if (const std::size_t open = buffer.find('['); open != std::string_view::npos && buffer.ends_with(']')) {
    const std::string_view index = buffer.substr(open + 1, buffer.size() - open - 2);
    const auto selector = read_index(index);
    path.member_span = span(index);
    if (!selector) return fail(index, in_quotes(index) + " is not an index", index_hint);
    path.member = *selector;
    buffer = buffer.substr(0, open);
  }
  for (const std::string_view part : {agent, subsystem, has_buffer ? buffer : subsystem}) {
    if (!is_identifier(part)) return fail(all, in_quotes(all) + " does not name a buffer", path_hint);
  }
  path.agent = agent;
  path.subsystem = subsystem;
  path.buffer = buffer;
  path.agent_span = span(agent);
  path.subsystem_span = span(subsystem);
  path.buffer_span = span(buffer);
  return path;
}

}  // namespace

std::optional<BufferPath> split_path(const Node& text, std::size_t offset, std::size_t length,
                                     Diagnostics& out) {
  return split(text, offset, length, /*needs_buffer=*/true, out);
}

std::optional<BufferPath> split_device_path(const Node& text, Diagnostics& out) {
  return split(text, 0, text.text.size(), /*needs_buffer=*/false, out);
}

PathLookup::PathLookup(const Model& model, const AgentGroups& groups) : model_(model), groups_(groups) {
  for (const auto& [name, group] : groups) names_.push_back(name);
  std::sort(names_.begin(), names_.end());
}

const AgentGroup* PathLookup::find_group(const std::string& agent, Span span, Diagnostics& out) const {
  const auto group = groups_.find(agent);
  if (group != groups_.end()) return &group->second;
  out.error("E101", span, "unknown agent " + in_quotes(agent), did_you_mean(agent, names_));
  return nullptr;
}

bool PathLookup::check_index(const Selector& selector, const AgentGroup& group, Span agent_span,
                             Span index_span, Diagnostics& out) {
  if (group.fleet && selector.kind == Selector::Kind::plain) {
    out.error("E112", agent_span,
              in_quotes(group.name) + " is a fleet of " + std::to_string(group.count) + " agents",
              "say which: " + group.name + "[0], " + group.name + "[i] or " + group.name + "[*]");
    return false;
  }
  if (!group.fleet && selector.kind != Selector::Kind::plain) {
    out.error("E112", index_span, in_quotes(group.name) + " is one agent, not a fleet",
              "write " + group.name + " without an index, or give it a 'count'");
    return false;
  }
  if (selector.kind == Selector::Kind::constant && (selector.number < 0 || selector.number >= group.count)) {
    out.error("E303", index_span,
              "there is no agent " + std::to_string(selector.number) + " in fleet " + in_quotes(group.name),
              "its agents are numbered 0 to " + std::to_string(group.count - 1));
    return false;
  }
  return true;
}

bool PathLookup::find(const BufferPath& path, PathTarget& target, KnownUpTo& known, Diagnostics& out) const {
  known = KnownUpTo::nothing;
  target.group = find_group(path.agent, path.agent_span, out);
  if (target.group == nullptr) return false;
  known = KnownUpTo::agent;
  if (!target.group->definition.valid()) return false;  // complained about already
  const auto& subsystems = model_.definitions[target.group->definition].subsystems;
  const auto subsystem = std::find_if(subsystems.begin(), subsystems.end(),
                                      [&path](const Subsystem& one) { return one.name == path.subsystem; });
  const bool good_index = check_index(path.selector, *target.group, path.agent_span, path.index_span, out);
  if (subsystem == subsystems.end()) {
    std::vector<std::string> names;
    for (const Subsystem& one : subsystems) names.push_back(one.name);
    out.error("E101", path.subsystem_span, "unknown subsystem " + in_quotes(path.subsystem),
              did_you_mean(path.subsystem, names));
    return false;
  }
  target.subsystem = {static_cast<std::uint32_t>(subsystem - subsystems.begin())};
  known = KnownUpTo::subsystem;
  return good_index;
}

bool PathLookup::check_member(const BufferPath& path, const Field& buffer, const std::string& what,
                              Diagnostics& out) {
  if (!buffer.member) {
    if (path.member.kind == Selector::Kind::plain) return true;
    out.error("E286", path.member_span,
              in_quotes(path.buffer) + " is one " + what + ", not one for each member of a fleet",
              "write " + path.buffer + " without an index, or declare it as \"TYPE[each FLEET]\"");
    return false;
  }
  const Member& family = *buffer.member;
  if (family.fleet.empty()) return false;  // complained about already
  const std::string owner = "one " + what + " for each " + family.fleet;
  if (path.member.kind == Selector::Kind::plain) {
    out.error("E287", path.buffer_span, in_quotes(path.buffer) + " is " + owner + ": which?",
              "write " + path.buffer + "[i], with " + family.fleet + "[i] at the other end, or " +
                  first_of(family));
    return false;
  }
  if (path.member.kind == Selector::Kind::constant &&
      (path.member.number < 0 || path.member.number >= std::int64_t{family.count})) {
    out.error(
        "E289", path.member_span,
        in_quotes(path.buffer) + " has no member " + std::to_string(path.member.number) + ": it is " + owner,
        "the members are numbered 0 to " + std::to_string(family.count - 1));
    return false;
  }
  return true;
}

void PathLookup::complain_about_buffer(const BufferPath& path, const PathTarget& target,
                                       const std::vector<Field>& buffers, const std::string& what,
                                       Diagnostics& out) const {
  const Subsystem& owner = subsystem(target);
  struct Other {
    const std::vector<Field>& fields;
    std::string_view is;
  };
  const std::array others = {Other{owner.inputs, "an input: a channel leads to it"},
                             Other{owner.outputs, "an output: a channel begins at it"},
                             Other{owner.real, "a real buffer: a driver stands behind it"}};
  for (const Other& other : others) {
    const bool here = std::any_of(other.fields.begin(), other.fields.end(), [&path](const Field& one) {
      return (one.member ? one.member->family : one.name) == path.buffer;
    });
    if (!here) continue;
    out.error("E304", path.buffer_span, in_quotes(path.buffer) + " is no " + what,
              "it is " + std::string(other.is));
    return;
  }
  std::vector<std::string> names;
  for (const Field& field : buffers)
    if (!field.member || field.member->number == 0)
      names.push_back(field.member ? field.member->family : field.name);
  out.error("E101", path.buffer_span, "unknown " + what + " " + in_quotes(path.buffer),
            did_you_mean(path.buffer, names));
}

const Subsystem& PathLookup::subsystem(const PathTarget& target) const {
  return model_.definitions[target.group->definition].subsystems[target.subsystem];
}

InstanceId PathLookup::instance(const PathTarget& target, std::uint32_t number) const {
  return model_.agents[target.group->agent(number)].instance(target.subsystem);
}

}  // namespace tessera::spec
