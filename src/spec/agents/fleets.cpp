#include "spec/agents/fleets.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

#include "diagnostics/utf8.hpp"
#include "spec/agents/definitions.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr std::uint32_t largest_fleet = 100'000;
/// A net of so many agents takes a third of a gigabyte.
constexpr std::size_t usual_most_agents = 10'000;
constexpr const char* most_agents_variable = "TESSERA_MOST_AGENTS";

std::size_t most_agents() {
  const char* const given = std::getenv(most_agents_variable);
  if (given == nullptr) return usual_most_agents;
  const std::string_view text = given;
  std::size_t most = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), most);
  return error == std::errc() && stop == text.data() + text.size() ? most : usual_most_agents;
}

std::uint32_t read_count(const Entry& entry, Diagnostics& out) {
  const Node* text = text_of(*entry.value, entry.span, "count", out, "write a number of agents");
  if (text == nullptr) return 1;
  std::uint32_t count = 0;
  const char* const end = text->text.data() + text->text.size();
  const auto [stop, error] = std::from_chars(text->text.data(), end, count);
  if (stop == end && error == std::errc() && count >= 1 && count <= largest_fleet && !text->quoted)
    return count;
  out.error("E206", text->span,
            "count must be a whole number between 1 and 100000, not " + in_quotes(text->text));
  return 1;
}

/// Builds agents from the entries of the file, one by one.
class Builder {
 public:
  Builder(const SystemScope& around, Model& model, Diagnostics& out)
      : around_(around), model_(model), out_(out) {}

  void read_templates(const Entry* section) { templates_.read(section, around_, model_, out_); }

  void read_agent(const Entry& entry) {
    check_name(entry.key, entry.span, "agent", out_);
    const bool uses = std::any_of(entry.value->entries.begin(), entry.value->entries.end(),
                                  [](const Entry& key) { return key.key == "use"; });
    AgentGroup group;
    group.name = entry.key;
    group.first_agent = model_.agents.next_id();
    if (uses) {
      read_use(entry, group);
    } else {
      read_size(entry.value->entries, group);
      group.definition = model_.definitions.next_id();
      model_.definitions.push_back(read_definition(entry, false, around_, out_));
    }
    if (group.definition.valid()) create(group, entry.span);
    groups_.emplace(entry.key, group);
  }

  AgentGroups finish() {
    templates_.complain_about_unused(out_);
    return std::move(groups_);
  }

 private:
  void read_use(const Entry& entry, AgentGroup& group) {
    const Section section(*entry.value, entry.span, "an agent with 'use'", {"use", "count", "ring"}, out_);
    const Entry* use = section.find("use");
    if (const Node* name = text_of(*use->value, use->span, "use", out_, "name a template")) {
      group.definition = templates_.find(*name, out_);
    }
    read_size(entry.value->entries, group);
  }

  /// `count` and `ring` among the keys of an agent.
  void read_size(const std::vector<Entry>& keys, AgentGroup& group) {
    const Entry* ring = nullptr;
    for (const Entry& key : keys) {
      if (key.key == "ring") ring = &key;
      if (key.key != "count") continue;
      group.fleet = true;
      group.count = read_count(key, out_);
      limit(group.count, key.value->span);
    }
    if (ring == nullptr) return;
    group.ring = bool_of(*ring, "ring", out_);
    if (!group.fleet) out_.error("E103", ring->span, "'ring' needs 'count'", "for example count: 50");
  }

  /// The whole system has at most most_agents().
  void limit(std::uint32_t& count, Span span) {
    const std::size_t most = most_agents(), all = model_.agents.size() + count;
    if (all <= most) return;
    out_.error("E206", span,
               "the system has " + std::to_string(all) + " agents with these, and Tessera takes at most " +
                   std::to_string(most),
               std::string(most_agents_variable) + "=" + std::to_string(all) +
                   " in the environment raises the limit; a net takes about 35 MB for 1000 agents");
    const std::size_t left = most > model_.agents.size() ? most - model_.agents.size() : 1;
    count = static_cast<std::uint32_t>(std::max<std::size_t>(left, 1));
  }

  void create(const AgentGroup& group, Span span) {
    const auto& subsystems = model_.definitions[group.definition].subsystems;
    const FleetId fleet = group.fleet ? FleetId{fleets_++} : FleetId{};
    for (std::uint32_t number = 0; number < group.count; ++number) {
      Agent agent;
      agent.path = group.fleet ? group.name + "[" + std::to_string(number) + "]" : group.name;
      agent.definition = group.definition;
      agent.fleet = fleet;
      agent.number = number;
      agent.first_instance = model_.instances.next_id();
      agent.span = span;
      for (const DefinedSubsystemId subsystem : subsystems.ids())
        model_.instances.push_back({model_.agents.next_id(), subsystem});
      model_.agents.push_back(std::move(agent));
    }
  }

  const SystemScope& around_;
  Model& model_;
  Diagnostics& out_;
  Templates templates_;
  AgentGroups groups_;
  std::uint32_t fleets_ = 0;
};

/// Checks names of types, agents and subsystems, which become C++ names that may meet in one scope.
void check_clashes(const Model& model, const std::vector<Structure>& structures, Diagnostics& out) {
  std::unordered_map<std::string, const Structure*> types;
  for (const Structure& structure : structures) types.emplace(structure.name, &structure);
  const auto check = [&](const std::string& name, Span span, const std::string& what) {
    const auto clash = types.find(name);
    if (clash == types.end()) return;
    out.error(
        "E107", span, what + " " + in_quotes(name) + " has the name of a type",
        "the type is on " + out.words(clash->second->span.line) + "; begin types with a capital letter");
  };
  for (const Definition& definition : model.definitions) {
    for (const Subsystem& subsystem : definition.subsystems)
      check(subsystem.name, subsystem.span, "subsystem");
    check(definition.name, definition.span, definition.is_template ? "template" : "agent");
  }
  for (const Agent& agent : model.agents) {
    if (agent.number == 0) check(agent.path.substr(0, agent.path.find('[')), agent.span, "agent");
  }
}

/// Checks the names of definitions, each of which becomes a namespace.
void check_definitions(const Model& model, Diagnostics& out) {
  std::unordered_map<std::string, Span> spans;
  for (const Definition& definition : model.definitions) {
    const auto [first, added] = spans.emplace(definition.name, definition.span);
    if (added) continue;
    out.error("E107", definition.span, "agent " + in_quotes(definition.name) + " has the name of a template",
              "the template is on " + out.words(first->second.line));
  }
}

}  // namespace

AgentGroups read_agents(const Entry* templates, const Entry* agents, const SystemScope& around, Model& model,
                        Diagnostics& out) {
  Builder builder(around, model, out);
  builder.read_templates(templates);
  if (agents != nullptr) {
    const auto& entries = entries_of(*agents->value, agents->span, "agents", out);
    if (entries.empty() && (agents->value->is_map() || agents->value->is_null())) {
      out.error("E103", agents->span, "a system needs at least one agent");
    }
    for (const Entry& entry : entries) builder.read_agent(entry);
  }
  AgentGroups groups = builder.finish();
  check_clashes(model, around.types.structures(), out);
  check_definitions(model, out);
  return groups;
}

}  // namespace tessera::spec
