#include "ros2/arguments/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

#include "ros2/naming/names.hpp"
#include "tessera/nearest.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::string_view value_sign = ":=";
constexpr std::string_view parameters_key = "ros__parameters";
constexpr std::string_view all_nodes = "/**";

std::optional<bool> truth_of(std::string_view text) {
  static constexpr std::array yes{"Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"};
  static constexpr std::array no{"N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"};
  if (std::ranges::find(yes, text) != yes.end()) return true;
  if (std::ranges::find(no, text) != no.end()) return false;
  return std::nullopt;
}

/// As strtoll with any base reads it: 0x10 is 16, and 010 is 8.
std::optional<std::int64_t> whole_of(const std::string& text) {
  char* end = nullptr;
  errno = 0;
  const long long number = std::strtoll(text.c_str(), &end, 0);
  if (errno != 0 || end == text.c_str() || *end != '\0') return std::nullopt;
  return number;
}

std::optional<double> real_of(const std::string& text) {
  for (const std::string_view infinite : {".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"})
    if (text == infinite) return std::numeric_limits<double>::infinity();
  for (const std::string_view infinite : {"-.inf", "-.Inf", "-.INF"})
    if (text == infinite) return -std::numeric_limits<double>::infinity();
  for (const std::string_view none : {".nan", ".NaN", ".NAN"})
    if (text == none) return std::numeric_limits<double>::quiet_NaN();
  if (text.find_first_of("0123456789") == std::string::npos) return std::nullopt;  // "inf" is a text
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0') return std::nullopt;
  return number;
}

Result<ParameterValue> scalar_value(const YamlNode& node) {
  if (node.quoted) return ParameterValue(node.text);
  if (node.text.empty() || node.text == "~" || node.text == "null" || node.text == "Null" ||
      node.text == "NULL")
    return Problem{"a parameter has no value"};
  if (const auto truth = truth_of(node.text)) return ParameterValue(*truth);
  if (const auto whole = whole_of(node.text)) return ParameterValue(*whole);
  if (const auto real = real_of(node.text)) return ParameterValue(*real);
  return ParameterValue(node.text);
}

template <class Value>
ParameterValue array_of(const std::vector<ParameterValue>& all) {
  std::vector<Value> values;
  for (const ParameterValue& one : all) values.push_back(std::get<Value>(one));
  return values;
}

Result<ParameterValue> list_value(const YamlNode& list) {
  std::vector<ParameterValue> all;
  for (const YamlNode& item : list.items) {
    if (item.kind != YamlNode::Kind::scalar) return Problem{"an element of a list is no single value"};
    Result<ParameterValue> one = scalar_value(item);
    if (!one) return one;
    if (!all.empty() && one->index() != all.front().index())
      return Problem{"the elements of a list have different types, as integers (1) and doubles (1.0) are"};
    all.push_back(*std::move(one));
  }
  if (all.empty()) return Problem{"an empty list has no type"};
  if (std::holds_alternative<bool>(all.front())) return array_of<bool>(all);
  if (std::holds_alternative<std::int64_t>(all.front())) return array_of<std::int64_t>(all);
  if (std::holds_alternative<double>(all.front())) return array_of<double>(all);
  return array_of<std::string>(all);
}

/// Collects the values of one file.
class FileReader {
 public:
  explicit FileReader(const std::string& file) { read_.name = file; }

  std::optional<Problem> read(const YamlNode& root) {
    if (root.kind != YamlNode::Kind::map) return wrong(root.line, "the file is no map of nodes");
    for (const auto& [key, node] : root.entries)
      if (auto problem = read_node(key, node)) return problem;
    return std::nullopt;
  }
  [[nodiscard]] const OverrideFile& result() const { return read_; }

 private:
  [[nodiscard]] Problem wrong(std::size_t line, const std::string& why) const {
    return Problem{fmt::format("{}:{}: {}", read_.name, line, why)};
  }

  /// Keys may be parts of the name of a node: "left: { robot: { ros__parameters: ... } }".
  std::optional<Problem> read_node(const std::string& name, const YamlNode& node) {
    if (node.kind != YamlNode::Kind::map || name == parameters_key)
      return wrong(node.line, name == parameters_key
                                  ? "'ros__parameters' stands below the name of a node, or below /**"
                                  : fmt::format("'{}' is no map; parameters stand below NODE: and "
                                                "`ros__parameters:`",
                                                name));
    for (const auto& [key, inner] : node.entries) {
      std::optional<Problem> problem;
      if (key != parameters_key) {
        problem = read_node(name + (name.ends_with('/') ? "" : "/") + key, inner);
      } else if (inner.kind != YamlNode::Kind::map) {
        problem = wrong(inner.line, "'ros__parameters' is no map");
      } else {
        read_.nodes.push_back(name);
        problem = read_values(name, "", inner);
      }
      if (problem) return problem;
    }
    return std::nullopt;
  }

  std::optional<Problem> read_values(const std::string& nodes, const std::string& above,
                                     const YamlNode& map) {
    for (const auto& [key, node] : map.entries) {
      const std::string name = above.empty() ? key : above + "." + key;
      if (node.kind == YamlNode::Kind::map) {
        if (auto problem = read_values(nodes, name, node)) return problem;
        continue;
      }
      Result<ParameterValue> value = parameter_value(node);
      if (!value) return wrong(node.line, name + ": " + value.problem());
      read_.values.push_back({nodes, name, *std::move(value), fmt::format("{}:{}", read_.name, node.line)});
    }
    return std::nullopt;
  }

  OverrideFile read_;
};

std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> parts;
  while (!name.empty()) {
    const std::size_t slash = std::min(name.find('/'), name.size());
    if (slash > 0) parts.push_back(name.substr(0, slash));
    name.remove_prefix(std::min(slash + 1, name.size()));
  }
  return parts;
}

bool fits(std::span<const std::string_view> pattern, std::span<const std::string_view> parts) {
  if (pattern.empty()) return parts.empty();
  if (pattern.front() == "**")
    return fits(pattern.subspan(1), parts) || (!parts.empty() && fits(pattern, parts.subspan(1)));
  return !parts.empty() && (pattern.front() == "*" || pattern.front() == parts.front()) &&
         fits(pattern.subspan(1), parts.subspan(1));
}

std::vector<std::string> names_in(std::span<const NodeWithParameters> nodes) {
  std::vector<std::string> names;
  for (const NodeWithParameters& node : nodes)
    for (const NamedParameter& one : node.parameters) names.push_back(one.name);
  return names;
}

std::string listed_parameters(const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t index = 0; index < std::min(most, names.size()); ++index)
    text += (index == 0 ? "" : ", ") + names[index];
  return text + (names.size() > most ? fmt::format(" and {} more", names.size() - most) : "");
}

/// nullopt: it is another parameter, or has no effect.
std::optional<std::string> complaint_about_time(const Override& one) {
  if (const bool* const used = std::get_if<bool>(&one.value); used != nullptr && !*used) return std::nullopt;
  return fmt::format(
      "{}: use_sim_time: a run keeps the steady clock of the machine, since its timeouts, watchdogs and safe "
      "commands must work when /clock stands still; leave it out, or give false (docs/use/ros2.md)",
      one.where);
}

}  // namespace

Result<ParameterValue> parameter_value(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::map) return Problem{"a map is no value"};
  return node.kind == YamlNode::Kind::list ? list_value(node) : scalar_value(node);
}

Result<Override> parse_override(std::string_view written) {
  const auto wrong = [&](const std::string& why) {
    return Problem{fmt::format("'{}' gives no parameter: {}", written, why)};
  };
  const std::size_t middle = written.find(value_sign);
  if (middle == std::string_view::npos)
    return wrong("it has no ':='; write NAME:=VALUE, such as control.kp:=0.8");
  Override made{.nodes = std::string(all_nodes), .name = std::string(written.substr(0, middle))};
  if (const std::size_t colon = made.name.find(':'); colon != std::string::npos) {
    made.nodes = "/**/" + made.name.substr(0, colon);  // the name alone, in any namespace
    if (!is_node_name(std::string_view(made.name).substr(0, colon)))
      return wrong("'" + made.name.substr(0, colon) + "' is no name of a node");
    made.name.erase(0, colon + 1);
  }
  if (made.name.empty()) return wrong("the name is missing");
  const Result<YamlNode> node = read_yaml(written.substr(middle + value_sign.size()));
  if (!node) return wrong(node.problem().substr(node.problem().find(' ') + 1));
  Result<ParameterValue> value = parameter_value(*node);
  if (!value) return wrong(value.problem());
  made.value = *std::move(value);
  made.where = fmt::format("-p {}", written);
  return made;
}

Result<OverrideFile> overrides_in(std::string_view text, const std::string& file) {
  const Result<YamlNode> root = read_yaml(text);
  if (!root) return Problem{file + ":" + root.problem()};
  FileReader reader(file);
  if (auto problem = reader.read(*root)) return *std::move(problem);
  return reader.result();
}

Result<OverrideFile> read_override_file(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad()) return Problem{"cannot read the parameters in '" + file + "'"};
  return overrides_in(text, file);
}

bool is_meant(std::string_view nodes, const NodeName& node) {
  const std::string full = node.full();
  const auto pattern = parts_of(nodes), parts = parts_of(full);
  return fits(pattern, parts);
}

Result<std::vector<Ros2Host::Change>> changes_of(std::span<const Override> overrides,
                                                 std::span<const NodeWithParameters> nodes) {
  std::vector<Ros2Host::Change> changes;
  std::string complaints;
  const auto complain = [&](const std::string& text) {
    complaints += (complaints.empty() ? "" : "\n") + text;
  };
  for (const Override& one : overrides) {
    bool meant = false, found = false;
    std::vector<NodeWithParameters> asked;
    for (const NodeWithParameters& node : nodes) {
      if (!is_meant(one.nodes, node.node)) continue;
      meant = true;
      asked.push_back(node);
      for (const NamedParameter& known : node.parameters) {
        if (known.name != one.name) continue;
        found = true;
        if (Result<std::string> text = text_for(*known.parameter, one.value))
          changes.emplace_back(known.parameter->path, *text);
        else
          complain(one.where + ": " + text.problem());
      }
    }
    if (!meant || found) continue;
    if (one.name == "use_sim_time") {
      if (const auto complaint = complaint_about_time(one)) complain(*complaint);
      continue;
    }
    const std::vector<std::string> names = names_in(asked);
    complain(
        with_hint(fmt::format("{}: no parameter '{}' in {}{}", one.where, one.name,
                              asked.size() == 1 ? "the node " + asked.front().node.full() : "the nodes",
                              names.empty() ? ", without parameters" : ", with " + listed_parameters(names)),
                  did_you_mean(one.name, names)));
  }
  if (!complaints.empty()) return Problem{std::move(complaints)};
  return changes;
}

}  // namespace tessera::ros2
