#pragma once

#include <set>
#include <utility>

#include "spec/agents/fleets.hpp"
#include "spec/channels/models.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {

/// The facts that the checks of the wiring need besides the channels themselves.
struct WiringExcuses {
  std::set<std::pair<InstanceId, BufferId>> inputs;  ///< left without a source by the end of a
                                                     ///< fleet, or by a channel with a mistake in it
  std::set<InstanceId> instances;                    ///< a channel with a mistake leads to some input of it
  std::set<AgentId> agents;  ///< a channel with a mistake leads to some subsystem of it
  bool everything = false;   ///< a channel with a mistake has unknown ends
  bool outputs = false;      ///< a channel with a mistake begins somewhere
};

/// Reads `channels` into model.channels, fleets expanded. entry may be null.
///
/// Errors: E101 and E112 paths; E104 form; E207 and E208 types and units of the ends; E301 two sources;
///         E303 index; E304 the wrong end; E306 timeouts where nothing blocks; E307 index forms that do not
///         go together; E309 `send` or `receive` beside `model`, a model without its timeout.
/// Warnings: W310 an unusual direction.
[[nodiscard]] WiringExcuses read_channels(const Entry* entry, const Types& types, const AgentGroups& groups,
                                          CommunicationModels& models, Model& model, Diagnostics& out);

}  // namespace tessera::spec
