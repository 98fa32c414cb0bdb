#include "spec/agents/deployment.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "spec/agents/paths.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/channel_limits.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* agents_hint = "name agents: base, robot[3] or robot[*]";

/// The key of a process: "base" or "cart[*]".
struct ProcessKey {
  std::string name;
  bool per_member = false;  ///< one process for each member of a fleet
};

/// A group of agents as a process names it.
struct Selection {
  const AgentGroup* group = nullptr;
  Selector selector;
  Span span;

  [[nodiscard]] bool whole_fleet() const { return selector.kind == Selector::Kind::all; }
};

/// A name of a machine or of an interface, or an address.
bool is_network_name(std::string_view text) {
  const auto fits = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view(".-_:").find(c) != std::string_view::npos;
  };
  return text.size() <= 253 && !text.empty() && text.front() != '-' && std::ranges::all_of(text, fits);
}

class DeploymentReader {
 public:
  DeploymentReader(const AgentGroups& groups, Model& model, Diagnostics& out)
      : lookup_(model, groups), model_(model), out_(out) {}

  void read(const Entry& entry) {
    const std::size_t before = out_.error_count();
    const Section section(*entry.value, entry.span, "a deployment", {"domain", "liveliness", "processes"},
                          out_);
    if (!section.readable()) return;
    deployment_.span = entry.span;
    if (const Entry* domain = section.find("domain")) read_domain(*domain);
    if (const Entry* liveliness = section.find("liveliness")) read_liveliness(*liveliness);
    const Entry* processes =
        section.require("processes", "for example processes: { base: base, carts: \"cart[*]\" }");
    if (processes == nullptr) return;
    const auto& entries = entries_of(*processes->value, processes->span, "processes", out_);
    if (entries.empty() && (processes->value->is_map() || processes->value->is_null()))
      out_.error("E103", processes->span, "a deployment needs at least one process", "NAME: AGENTS");
    for (const Entry& process : entries) read_process(process);
    if (incomplete_ || out_.error_count() > before) return;
    complain_about_the_rest(processes->span);
    if (out_.error_count() > before) return;
    settle();
    check_models();
    warn_of_partial_stops();
  }

 private:
  void read_domain(const Entry& domain) {
    const auto number = read_number(*domain.value, domain.span, "domain", out_);
    if (!number) return;
    if (*number < 0 || *number > last_domain || *number != std::floor(*number))
      out_.error("E206", domain.value->span,
                 "a DDS domain is a whole number from 0 to " + std::to_string(last_domain));
    else
      deployment_.domain = static_cast<std::uint32_t>(*number);
  }

  void read_liveliness(const Entry& liveliness) {
    const auto time = read_duration(*liveliness.value, liveliness.span, "liveliness", out_);
    if (!time) return;
    if (*time < shortest_liveliness || *time > longest_liveliness)
      out_.error("E206", liveliness.value->span, "liveliness must lie between 100 ms and 10 s");
    else
      deployment_.liveliness = *time;
  }

  void read_process(const Entry& entry) {
    const auto key = read_key(entry);
    Process common;
    common.span = entry.span;
    std::vector<Selection> selections;
    bool good = key.has_value();
    if (entry.value->is_map()) {
      const Section section(*entry.value, entry.span, "a process", {"agents", "host", "interface"}, out_);
      if (const Entry* host = section.find("host")) common.host = network_name(*host, "host");
      if (const Entry* interface = section.find("interface"))
        common.interface = network_name(*interface, "interface");
      const Entry* agents = section.require("agents", agents_hint);
      if (agents == nullptr) return;
      good = read_agents(*agents->value, agents->span, selections) && good;
    } else {
      good = read_agents(*entry.value, entry.span, selections) && good;
    }
    if (!good) return;
    if (key->per_member)
      one_per_member(*key, common, selections);
    else
      together(*key, std::move(common), selections);
  }

  std::optional<ProcessKey> read_key(const Entry& entry) {
    const std::string_view text = entry.key;
    const std::size_t bracket = text.find('[');
    ProcessKey key{std::string(text.substr(0, bracket)), bracket != std::string_view::npos};
    if (key.per_member) {
      const bool closed = text.ends_with(']');
      const auto index =
          closed ? read_index(text.substr(bracket + 1, text.size() - bracket - 2)) : std::nullopt;
      if (!index || index->kind != Selector::Kind::all) {
        out_.error("E112", entry.span, in_quotes(entry.key) + " names no processes",
                   "write " + key.name + ", or " + key.name + "[*] for one process per member of a fleet");
        return std::nullopt;
      }
    }
    if (!check_name(key.name, entry.span, "process", out_)) return std::nullopt;
    const auto [first, added] = lines_.emplace(key.name, entry.span.line);
    if (added) return key;
    out_.error("E107", entry.span, "the name of process " + in_quotes(key.name) + " is taken",
               "by the process on " + out_.words(first->second));
    return std::nullopt;
  }

  std::string network_name(const Entry& entry, const char* what) {
    const Node* text = text_of(*entry.value, entry.span, what, out_, "a name or an address");
    if (text == nullptr) return {};
    if (is_network_name(text->text)) return text->text;
    out_.error("E104", text->span, in_quotes(text->text) + " is no " + what,
               "a name or an address: letters, digits and . - _ :");
    return {};
  }

  bool read_agents(const Node& node, Span at, std::vector<Selection>& selections) {
    std::vector<const Node*> texts{&node};
    if (node.is_sequence()) texts = node.items;
    bool good = true;
    for (const Node* text : texts) {
      const std::optional<Selection> one = read_selection(*text, at);
      good = good && one;
      if (one) selections.push_back(*one);
    }
    if (texts.empty()) out_.error("E103", at, "a process needs at least one agent", agents_hint);
    return good && !texts.empty();
  }

  std::optional<Selection> read_selection(const Node& node, Span at) {
    const Node* text = text_of(node, at, "the agents of a process", out_, agents_hint);
    if (text == nullptr) return std::nullopt;
    const std::string_view all = text->text;
    const std::size_t bracket = all.find('[');
    Selection selection;
    selection.span = text->span;
    if (bracket != std::string_view::npos) {
      const auto index =
          all.ends_with(']') ? read_index(all.substr(bracket + 1, all.size() - bracket - 2)) : std::nullopt;
      if (!index || index->kind == Selector::Kind::variable) {
        out_.error("E112", text->span, in_quotes(text->text) + " names no agents", agents_hint);
        return std::nullopt;
      }
      selection.selector = *index;
    }
    selection.group = lookup_.find_group(std::string(all.substr(0, bracket)), text->span, out_);
    if (selection.group == nullptr) return std::nullopt;
    if (!selection.group->definition.valid()) {  // complained about already
      incomplete_ = true;
      return std::nullopt;
    }
    if (!PathLookup::check_index(selection.selector, *selection.group, text->span, text->span, out_))
      return std::nullopt;
    return selection;
  }

  void together(const ProcessKey& key, Process process, const std::vector<Selection>& selections) {
    process.name = key.name;
    for (const Selection& selection : selections) {
      std::vector<AgentId> agents;
      const AgentGroup& group = *selection.group;
      if (selection.whole_fleet())
        for (std::uint32_t number = 0; number < group.count; ++number) agents.push_back(group.agent(number));
      else if (const auto number = agent_number(selection.selector, group, 0))
        agents.push_back(group.agent(*number));
      if (!take(agents, selection.span)) return;
      process.agents.insert(process.agents.end(), agents.begin(), agents.end());
    }
    deployment_.processes.push_back(std::move(process));
  }

  void one_per_member(const ProcessKey& key, const Process& common,
                      const std::vector<Selection>& selections) {
    const std::uint32_t count = selections.front().group->count;
    for (const Selection& selection : selections) {
      if (!selection.whole_fleet())
        return out_.error("E307", selection.span,
                          in_quotes(key.name + "[*]") + " stands for one process per member of a fleet",
                          "name whole fleets here: robot[*]");
      if (selection.group->count != count)
        return out_.error("E307", selection.span,
                          "fleets of " + std::to_string(count) + " and " +
                              std::to_string(selection.group->count) + " agents share processes",
                          "member 3 of each goes to process 3, so they have to be of one size");
    }
    std::vector<Process> members(count, common);
    for (const Selection& selection : selections) {
      std::vector<AgentId> agents;
      for (std::uint32_t number = 0; number < count; ++number) {
        agents.push_back(selection.group->agent(number));
        members[number].agents.push_back(agents.back());
      }
      if (!take(agents, selection.span)) return;
    }
    for (std::uint32_t number = 0; number < count; ++number) {
      members[number].name = key.name + "[" + std::to_string(number) + "]";
      deployment_.processes.push_back(std::move(members[number]));
    }
  }

  /// false: one of the agents is in a process already.
  bool take(const std::vector<AgentId>& agents, Span at) {
    for (const AgentId agent : agents) {
      const auto [first, added] = taken_.emplace(agent, at.line);
      if (added) continue;
      out_.error(
          "E315", at, "agent " + in_quotes(model_.agents[agent].path) + " is in a process already",
          first->second == at.line ? "name it once" : "see " + out_.words(first->second) + ": name it once");
      return false;
    }
    return true;
  }

  void complain_about_the_rest(Span at) {
    constexpr std::size_t shown = 5;
    std::string names, example;
    std::size_t missing = 0;
    for (const AgentId agent : model_.agents.ids()) {
      if (taken_.contains(agent)) continue;
      const std::string& path = model_.agents[agent].path;
      if (missing++ == 0) example = path.substr(0, path.find('['));
      if (missing <= shown) names += (missing == 1 ? "" : ", ") + path;
    }
    if (missing == 0) return;
    if (missing > shown) names += " and " + std::to_string(missing - shown) + " more";
    out_.error(
        "E315", at, (missing == 1 ? "an agent is in no process: " : "agents are in no process: ") + names,
        "every agent runs in one process; add a line such as `" + example + ": " + agents_of(example) + "`");
  }

  [[nodiscard]] std::string agents_of(const std::string& group) const {
    return lookup_.groups().at(group).fleet ? group + "[*]" : group;
  }

  void settle() {
    for (const ProcessId process : deployment_.processes.ids()) {
      std::ranges::sort(deployment_.processes[process].agents);
      for (const AgentId agent : deployment_.processes[process].agents)
        model_.agents[agent].process = process;
    }
    model_.deployment = std::move(deployment_);
  }

  /// A model of the author says how two sides share one memory, and `blocking_once` reads it again; over a
  /// network there are two.
  void check_models() {
    std::map<std::uint32_t, bool> told;  // per line: a channel of fleets is reported once
    for (const Channel& channel : model_.channels) {
      const bool once = channel.receive == Mode::blocking_once;
      if ((!channel.model.valid() && !once) || !model_.crosses_processes(channel)) continue;
      if (!told.emplace(channel.span.line, true).second) continue;
      if (once)
        out_.error(
            "E242", channel.span, "a channel between processes cannot have 'receive: blocking_once'",
            "its sides share one memory: put both agents into one process, or write receive: blocking");
      else
        out_.error(
            "E316", channel.span,
            "a channel between processes cannot have the communication model " +
                in_quotes(model_.models[channel.model].name),
            "its sides share one memory: put both agents into one process, or use `send` and `receive`");
    }
  }

  /// The author of `recovery: operator` may expect that the whole system stops.
  void warn_of_partial_stops() {
    if (model_.deployment->processes.size() < 2) return;
    for (const Definition& definition : model_.definitions)
      for (const Subsystem& subsystem : definition.subsystems)
        if (subsystem.operator_resets)
          out_.warning("W327", subsystem.span,
                       "the emergency stop of effector " + in_quotes(subsystem.name) +
                           " reaches the devices of its own process only",
                       "`tessera emergency-stop` reaches the processes of a machine; "
                       "a channel can tell the others");
  }

  PathLookup lookup_;
  Model& model_;
  Diagnostics& out_;
  Deployment deployment_;
  std::map<std::string, std::uint32_t> lines_;  ///< name of a process -> its line
  std::map<AgentId, std::uint32_t> taken_;      ///< agent -> line of its process
  bool incomplete_ = false;                     ///< an agent that is named could not be read
};

}  // namespace

void read_deployment(const Entry* entry, const AgentGroups& groups, Model& model, Diagnostics& out) {
  if (entry != nullptr) DeploymentReader(groups, model, out).read(*entry);
}

}  // namespace tessera::spec
