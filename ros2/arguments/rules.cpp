#include "ros2/arguments/rules.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

#include "ros2/naming/names.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::string_view rule_sign = ":=";
constexpr std::string_view private_prefix = "~/";

Problem wrong_rule(std::string_view rule, const std::string& why) {
  return Problem{"'" + std::string(rule) + "' is no rule for names: " + why};
}

/// A full, relative or private name.
bool is_name_in_rule(std::string_view name) {
  std::string ignored;
  if (name.starts_with(private_prefix)) name.remove_prefix(private_prefix.size());
  return !full_topic_name(name, ignored).empty();
}

std::string shown_name(std::string_view name) {
  return name.empty() ? "nothing" : "'" + std::string(name) + "'";
}

/// Takes "robot:" away, if the text begins with the name of a node. "rostopic://" is no such beginning.
std::string take_node(std::string_view& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || text.substr(colon).starts_with("://") ||
      text.substr(colon).starts_with(rule_sign))
    return {};
  const std::string_view node = text.substr(0, colon);
  if (!is_node_name(node)) return {};
  text.remove_prefix(colon + 1);
  return std::string(node);
}

std::optional<Rule::Of> take_kind(std::string_view& from) {
  for (const auto& [scheme, of] : {std::pair{std::string_view("rostopic://"), Rule::Of::topic},
                                   std::pair{std::string_view("rosservice://"), Rule::Of::service}})
    if (from.starts_with(scheme)) {
      from.remove_prefix(scheme.size());
      return of;
    }
  if (from == "__ns") return Rule::Of::name_space;
  if (from == "__node" || from == "__name") return Rule::Of::node;
  return from.starts_with("__") ? std::nullopt : std::optional(Rule::Of::any);
}

/// nullopt: the name after the separator is right. A slash at the end of a namespace is taken away.
std::optional<std::string> complaint_about_new(Rule& rule) {
  if (rule.of == Rule::Of::node) {
    if (is_node_name(rule.to)) return std::nullopt;
    return shown_name(rule.to) + " is no name of a node (letters, digits and single underscores, no slash)";
  }
  if (rule.of == Rule::Of::name_space) {
    if (rule.to.size() > 1 && rule.to.ends_with('/')) rule.to.pop_back();
    if (rule.to == "/" || (rule.to.starts_with('/') && is_name_in_rule(rule.to))) return std::nullopt;
    return shown_name(rule.to) + " is no namespace, which begins with a slash, such as /left";
  }
  if (is_name_in_rule(rule.to)) return std::nullopt;
  return shown_name(rule.to) + " is no name of a topic or service";
}

}  // namespace

Result<Rule> parse_rule(std::string_view written) {
  Rule rule{.written = std::string(written)};
  std::string_view text = written;
  const std::size_t middle = text.find(rule_sign);
  if (middle == std::string_view::npos)
    return wrong_rule(written, "it has no ':='; write FROM:=TO, such as /cmd_vel:=/base/cmd_vel");
  rule.to = std::string(text.substr(middle + rule_sign.size()));
  text = text.substr(0, middle);
  rule.node = take_node(text);
  const auto of = take_kind(text);
  if (!of) return wrong_rule(written, shown_name(text) + " is unknown; there are __node, __name and __ns");
  rule.of = *of;
  if (rule.of != Rule::Of::node && rule.of != Rule::Of::name_space) {
    if (text.find('*') != std::string_view::npos) return wrong_rule(written, "ROS 2 has no wildcards here");
    if (!is_name_in_rule(text))
      return wrong_rule(written, shown_name(text) + " is no name of a topic or service");
    rule.from = std::string(text);
  }
  if (const auto complaint = complaint_about_new(rule)) return wrong_rule(written, *complaint);
  return rule;
}

std::string NodeName::full() const { return (name_space == "/" ? "" : name_space) + "/" + name; }

NodeName node_name_in(std::string_view full) {
  const std::size_t slash = full.rfind('/');
  return {std::string(full.substr(slash + 1)),
          slash == 0 || slash == std::string_view::npos ? "/" : std::string(full.substr(0, slash))};
}

std::string expanded(std::string_view name, const NodeName& node) {
  if (name.starts_with('/')) return std::string(name);
  if (name.starts_with(private_prefix)) return node.full() + std::string(name.substr(1));
  return (node.name_space == "/" ? "" : node.name_space) + "/" + std::string(name);
}

NodeName Rules::node(const std::string& name) const { return node(name, nullptr); }

/// A prefix of a rule for the namespace is the new name of the node, as in ROS 2.
NodeName Rules::node(const std::string& name, Used* used) const {
  NodeName node{name};
  const auto apply = [&](Rule::Of of, std::string& part) {
    const std::string prefix = node.name;
    const auto fits = [&](const Rule& one) {
      return one.of == of && (one.node.empty() || one.node == prefix);
    };
    const auto rule = std::ranges::find_if(rules_, fits);
    if (rule == rules_.end()) return;
    part = rule->to;
    if (used != nullptr) used->insert(static_cast<std::size_t>(rule - rules_.begin()));
  };
  apply(Rule::Of::node, node.name);
  apply(Rule::Of::name_space, node.name_space);
  return node;
}

std::string Rules::name(Kind kind, std::string_view written, const NodeName& node) const {
  return name(kind, written, node, nullptr);
}

std::string Rules::name(Kind kind, std::string_view written, const NodeName& node, Used* used) const {
  const std::string full = expanded(written, node);
  const Rule::Of own = kind == Kind::topic ? Rule::Of::topic : Rule::Of::service;
  const auto rule = std::ranges::find_if(rules_, [&](const Rule& one) {
    return (one.of == own || one.of == Rule::Of::any) && (one.node.empty() || one.node == node.name) &&
           expanded(one.from, node) == full;
  });
  if (rule == rules_.end()) return full;
  if (used != nullptr) used->insert(static_cast<std::size_t>(rule - rules_.begin()));
  return expanded(rule->to, node);
}

namespace {

struct ProcessRules {
  std::mutex mutex;
  Rules rules;
};
ProcessRules& process_rules() {
  static ProcessRules rules;
  return rules;
}

}  // namespace

Rules rules_of_process() {
  ProcessRules& all = process_rules();
  const std::lock_guard lock(all.mutex);
  return all.rules;
}

void set_rules_of_process(Rules rules) {
  ProcessRules& all = process_rules();
  const std::lock_guard lock(all.mutex);
  all.rules = std::move(rules);
}

}  // namespace tessera::ros2
