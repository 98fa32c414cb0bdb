#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/result.hpp"

/// Other names for nodes, topics, services and actions, by the rules of ROS 2: `-r FROM:=TO`.
namespace tessera::ros2 {

/// "[NODE:]FROM:=TO"
struct Rule {
  enum class Of : std::uint8_t { topic, service, any, node, name_space } of = Of::any;
  std::string written{};  ///< the whole rule
  std::string node{};     ///< only for the node of that name, without namespace; empty: for all
  std::string from{};  ///< a name that is full, relative or begins with "~/"; of nodes and namespaces: empty
  std::string to{};    ///< the same; the name of a node; "/left"
};
/// Errors: the rule has another form, with the reason.
[[nodiscard]] Result<Rule> parse_rule(std::string_view written);

/// The name of a node in its namespace.
struct NodeName {
  std::string name;              ///< "robot"
  std::string name_space = "/";  ///< "/", "/left"

  [[nodiscard]] std::string full() const;  ///< "/robot", "/left/robot"
  auto operator<=>(const NodeName&) const = default;
};
/// The parts of "/left/robot". Precondition: it is a full name.
[[nodiscard]] NodeName node_name_in(std::string_view full);
/// "/left/scan" for the relative name "scan", "/left/robot/scan" for "~/scan", "/scan" for "/scan".
[[nodiscard]] std::string expanded(std::string_view name, const NodeName& node);

/// Rules in their order: the first one that fits counts.
///
/// Threads: any.
class Rules {
 public:
  Rules() = default;
  explicit Rules(std::vector<Rule> rules) : rules_(std::move(rules)) {}

  /// The final name of a node that the specification calls so.
  [[nodiscard]] NodeName node(const std::string& name) const;
  enum class Kind : std::uint8_t { topic, service };  ///< an action counts as a service
  /// The final, full name of a topic, service or action of a node with its final name.
  [[nodiscard]] std::string name(Kind kind, std::string_view written, const NodeName& node) const;

  /// The same, and notes the rules that fit.
  using Used = std::set<std::size_t>;
  [[nodiscard]] NodeName node(const std::string& name, Used* used) const;
  [[nodiscard]] std::string name(Kind kind, std::string_view written, const NodeName& node, Used* used) const;
  [[nodiscard]] std::span<const Rule> all() const { return rules_; }

 private:
  std::vector<Rule> rules_;
};

/// The rules of this process, for all its nodes. Threads: any.
[[nodiscard]] Rules rules_of_process();
/// Call it before a driver is made.
void set_rules_of_process(Rules rules);

}  // namespace tessera::ros2
