#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "spec/agents/subsystems.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// The agents that one entry of `agents` describes.
struct Group {
  std::string name;
  Index first_agent = 0;  ///< into Model::agents
  Index count = 1;
  bool fleet = false;       ///< `count` was given, so paths need an index
  bool ring = false;        ///< the first agent follows the last
  Index definition = none;  ///< none: it could not be read
};

/// Groups of agents by their names in the file.
using Groups = std::unordered_map<std::string, Group>;

/// Reads `templates` and `agents` into model.definitions, .agents and .instances. Either entry may be null.
///
/// Errors: E101 unknown template; E103 no agent; E105-E107 names; E109 a cycle of templates; E206 count.
/// Warnings: W319 an unused template.
[[nodiscard]] Groups read_agents(const Entry* templates, const Entry* agents, const Surroundings& around,
                                 Model& model, Diagnostics& out);

}  // namespace tessera::spec
