#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "spec/agents/subsystems.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// The agents that one entry of `agents` stands for.
struct AgentGroup {
  std::string name;
  AgentId first_agent{0};
  std::uint32_t count = 1;
  bool fleet = false;       ///< `count` was given, so paths need an index
  bool ring = false;        ///< the first agent follows the last
  DefinitionId definition;  ///< none: it could not be read

  [[nodiscard]] AgentId agent(std::uint32_t number) const { return {first_agent.value + number}; }
};

/// Agents by the name under which the file knows them.
using AgentGroups = std::unordered_map<std::string, AgentGroup>;

/// Reads `templates` and `agents` into model.definitions, .agents and .instances. Either entry may be null.
///
/// Errors: E101 unknown template; E103 nothing to build; E105-E107 names; E109 a cycle of templates; E206
/// count. Warnings: W319 a template nobody uses.
[[nodiscard]] AgentGroups read_agents(const Entry* templates, const Entry* agents, const SystemScope& around,
                                      Model& model, Diagnostics& out);

}  // namespace tessera::spec
