#include "ros2/arguments/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "ros2/naming/names.hpp"
#include "ros2/parameters/node_parameters.hpp"
#include "tessera/nearest.hpp"

namespace tessera::ros2 {
namespace {

enum class Flag : std::uint8_t { remap, parameter, file, enclave, ignored };
struct KnownFlag {
  std::string_view name;
  Flag flag;
  bool has_value = true;
};
constexpr std::array known_flags{KnownFlag{"-r", Flag::remap},
                                 KnownFlag{"--remap", Flag::remap},
                                 KnownFlag{"-p", Flag::parameter},
                                 KnownFlag{"--param", Flag::parameter},
                                 KnownFlag{"--params-file", Flag::file},
                                 KnownFlag{"-e", Flag::enclave},
                                 KnownFlag{"--enclave", Flag::enclave},
                                 KnownFlag{"--log-level", Flag::ignored},
                                 KnownFlag{"--log-config-file", Flag::ignored},
                                 KnownFlag{"--log-file-name", Flag::ignored},
                                 KnownFlag{"--enable-stdout-logs", Flag::ignored, false},
                                 KnownFlag{"--disable-stdout-logs", Flag::ignored, false},
                                 KnownFlag{"--enable-rosout-logs", Flag::ignored, false},
                                 KnownFlag{"--disable-rosout-logs", Flag::ignored, false},
                                 KnownFlag{"--enable-external-lib-logs", Flag::ignored, false},
                                 KnownFlag{"--disable-external-lib-logs", Flag::ignored, false}};

std::vector<std::string> flag_names() {
  std::vector<std::string> names;
  for (const KnownFlag& one : known_flags) names.emplace_back(one.name);
  return names;
}

std::optional<Problem> take(ParsedArguments& parsed, const KnownFlag& flag, const std::string& value) {
  switch (flag.flag) {
    case Flag::remap: {
      Result<Rule> rule = parse_rule(value);
      if (!rule) return Problem{rule.problem()};
      parsed.rules.push_back(*std::move(rule));
      break;
    }
    case Flag::parameter: {
      Result<Override> made = parse_override(value);
      if (!made) return Problem{made.problem()};
      parsed.overrides.emplace_back(*std::move(made));
      break;
    }
    case Flag::file:
      parsed.overrides.emplace_back(ParsedArguments::File{value});
      break;
    case Flag::enclave:
      if (value != "/")
        return Problem{
            fmt::format("{} {}: DDS security is not supported, so there are no enclaves", flag.name, value)};
      break;
    case Flag::ignored:
      parsed.without_effect.emplace_back(flag.name);
      break;
  }
  return std::nullopt;
}

/// A service or action counts as a service.
Rules::Kind kind_of(const Ros2Use& use) {
  return use.role.empty() && !is_action_type(use.type) ? Rules::Kind::topic : Rules::Kind::service;
}

std::string agent_of(const std::string& path) { return path.substr(0, path.find('.')); }

std::string own_node(const Ros2Use& use) {
  return use.node.empty() ? node_name_of(agent_of(use.path)) : use.node;
}

std::string listed_names(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The system with its final names.
class Renaming {
 public:
  Renaming(const Rules& rules, Ros2Arguments& arguments) : rules_(rules), arguments_(arguments) {}

  std::optional<Problem> run() {
    for (const Ros2Use& use : arguments_.uses) {
      const std::string written = own_node(use);
      const NodeName node = rules_.node(written, &used_);
      nodes_[node].insert(agent_of(use.path));
      if (auto problem = refuse_shared(written, node)) return problem;
      if (auto problem = rename(use, node)) return problem;
    }
    use_own_topics_of_nodes();
    warn_of_unused();
    return std::nullopt;
  }
  [[nodiscard]] const std::map<NodeName, std::set<std::string>>& nodes() const { return nodes_; }

 private:
  std::optional<Problem> refuse_shared(const std::string& written, const NodeName& node) {
    const auto [first, is_new] = written_names_.emplace(node, written);
    if (first->second != written)
      return Problem{
          fmt::format("the nodes {0} and {1} would both be {2}; write the node before the rule, such as "
                      "{0}:__node:=NAME",
                      first->second, written, node.full())};
    if (is_new && node.full() != "/" + written)
      arguments_.notes.push_back(fmt::format("the node /{} is {}", written, node.full()));
    return std::nullopt;
  }

  /// The two drivers of one side of a service or action find each other by its name.
  std::optional<Problem> rename(const Ros2Use& use, const NodeName& node) {
    std::string error;
    const std::string before = full_topic_name(use.topic, error);
    const std::string after = rules_.name(kind_of(use), use.topic, node, &used_);
    if (full_topic_name(after, error).empty()) return Problem{fmt::format("{}: {}", use.path, error)};
    names_.insert(expanded(use.topic, node));
    if (kind_of(use) == Rules::Kind::service) {
      const auto [first, is_new] = sides_.emplace(std::tuple(agent_of(use.path), use.role, before), after);
      if (!is_new && first->second != after)
        return Problem{fmt::format("the effector and the receptor of {} in {} would have the names {} and {}",
                                   before, agent_of(use.path), first->second, after)};
    }
    if (before != after && told_.emplace(before, after).second)
      arguments_.notes.push_back(fmt::format("{} is {}", before, after));
    return std::nullopt;
  }

  /// Each node has them without a driver.
  void use_own_topics_of_nodes() {
    for (const auto& [node, agents] : nodes_) {
      for (const char* topic : {"/diagnostics", "/parameter_events", "/tf", "/tf_static"})
        static_cast<void>(rules_.name(Rules::Kind::topic, topic, node, &used_));
      for (const ParameterServiceName& one : parameter_services)
        static_cast<void>(rules_.name(Rules::Kind::service, std::string("~/") + one.name, node, &used_));
    }
  }

  void warn_of_unused() {
    for (std::size_t index = 0; index < rules_.all().size(); ++index) {
      if (used_.contains(index)) continue;
      const Rule& rule = rules_.all()[index];
      std::string text = fmt::format("--ros-args: nothing here has the name in '{}'", rule.written);
      if (nodes_.empty()) {
        text += ": the system has no driver of ROS 2";
      } else if (!rule.node.empty() || rule.of == Rule::Of::node || rule.of == Rule::Of::name_space) {
        std::set<std::string> names;
        for (const auto& [node, agents] : nodes_) names.insert(node.full());
        text += ", or an earlier rule came first; the nodes are " + listed_names(names);
      } else {
        text += ", or an earlier rule came first";
        text = with_hint(text, did_you_mean(rule.from, {names_.begin(), names_.end()}));
      }
      arguments_.warnings.push_back(text);
    }
  }

  const Rules& rules_;
  Ros2Arguments& arguments_;
  Rules::Used used_;
  std::map<NodeName, std::set<std::string>> nodes_;  ///< with their agents
  std::map<NodeName, std::string> written_names_;
  std::set<std::string> names_;  ///< full names before the rules
  std::map<std::tuple<std::string, std::string, std::string>, std::string> sides_;
  std::set<std::pair<std::string, std::string>> told_;
};

std::vector<NodeWithParameters> nodes_with_parameters(const std::map<NodeName, std::set<std::string>>& nodes,
                                                      const std::vector<Ros2Parameter>& parameters) {
  std::vector<NodeWithParameters> all;
  for (const auto& [node, agents] : nodes) {
    NodeWithParameters& one = all.emplace_back(NodeWithParameters{node, {}});
    for (const Ros2Parameter& parameter : parameters)
      if (const auto name = name_in_node(agents, parameter.path))
        one.parameters.push_back({*name, &parameter});
  }
  return all;
}

/// A file for other nodes only is one with a wrong name in it, as far as this program can know.
std::optional<Problem> refuse_foreign(const OverrideFile& file,
                                      const std::vector<NodeWithParameters>& nodes) {
  std::set<std::string> own;
  for (const NodeWithParameters& node : nodes) own.insert(node.node.full());
  const bool is_ours = std::ranges::any_of(file.nodes, [&](const std::string& pattern) {
    return std::ranges::any_of(nodes, [&](const auto& node) { return is_meant(pattern, node.node); });
  });
  if (is_ours || file.nodes.empty()) return std::nullopt;
  return Problem{fmt::format(
      "{}: it has parameters of {}, and {}", file.name, listed_names({file.nodes.begin(), file.nodes.end()}),
      own.empty() ? "the system has no node of ROS 2" : "the nodes here are " + listed_names(own))};
}

std::optional<Problem> refuse_foreign(const Override& one, const std::vector<NodeWithParameters>& nodes) {
  if (std::ranges::any_of(nodes, [&](const auto& node) { return is_meant(one.nodes, node.node); }))
    return std::nullopt;
  return Problem{fmt::format("{}: there is no such node", one.where)};
}

Result<std::vector<Override>> overrides_of(const ParsedArguments& parsed,
                                           const std::vector<NodeWithParameters>& nodes) {
  std::vector<Override> all;
  for (const auto& given : parsed.overrides) {
    if (const auto* const one = std::get_if<Override>(&given)) {
      if (auto foreign = refuse_foreign(*one, nodes)) return *std::move(foreign);
      all.push_back(*one);
      continue;
    }
    Result<OverrideFile> file = read_override_file(std::get<ParsedArguments::File>(given).name);
    if (!file) return Problem{file.problem()};
    if (auto foreign = refuse_foreign(*file, nodes)) return *std::move(foreign);
    std::ranges::move(file->values, std::back_inserter(all));
  }
  return all;
}

}  // namespace

Result<ParsedArguments> parse_arguments(std::span<const std::string> words) {
  ParsedArguments parsed;
  for (std::size_t index = 0; index < words.size(); ++index) {
    const std::string& word = words[index];
    if (word == "--ros-args") continue;
    const auto flag = std::ranges::find(known_flags, word, &KnownFlag::name);
    if (flag == known_flags.end())
      return Problem{with_hint(
          fmt::format("--ros-args: '{}' is unknown; behind -- come arguments of the controller", word),
          did_you_mean(word, flag_names()))};
    std::string value;
    if (flag->has_value) {
      if (++index == words.size()) return Problem{fmt::format("--ros-args: {} has no value", word)};
      value = words[index];
    }
    if (auto problem = take(parsed, *flag, value)) return Problem{"--ros-args: " + problem->text};
  }
  return parsed;
}

std::optional<Problem> apply_arguments(Ros2Arguments& arguments) {
  Result<ParsedArguments> parsed = parse_arguments(arguments.words);
  if (!parsed) return Problem{parsed.problem()};
  const Rules rules(std::move(parsed->rules));
  Renaming renaming(rules, arguments);
  if (auto problem = renaming.run()) return Problem{"--ros-args: " + problem->text};
  const auto nodes = nodes_with_parameters(renaming.nodes(), arguments.parameters);
  const Result<std::vector<Override>> overrides = overrides_of(*parsed, nodes);
  if (!overrides) return Problem{overrides.problem()};
  Result<std::vector<Ros2Host::Change>> values = changes_of(*overrides, nodes);
  if (!values) return Problem{values.problem()};
  arguments.values = *std::move(values);
  if (!parsed->without_effect.empty())
    arguments.notes.push_back("without effect: " +
                              listed_names({parsed->without_effect.begin(), parsed->without_effect.end()}));
  set_rules_of_process(rules);
  return std::nullopt;
}

}  // namespace tessera::ros2
