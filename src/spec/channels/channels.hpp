#pragma once

#include <set>
#include <utility>

#include "spec/agents/fleets.hpp"
#include "spec/channels/models.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {

/// Mistakes that were reported already. The checks of the wiring do not report what follows from them.
struct Excuses {
  /// (instance, input) without a source, because the fleet ends there or because a channel has a mistake.
  std::set<std::pair<Index, Index>> inputs;
  std::set<Index> instances;  ///< a channel with a mistake leads to some input of the instance
  /// a channel with a mistake leads to some subsystem of the agent
  std::set<Index> agents;
  bool everything = false;  ///< a channel with a mistake leads to an unknown place
  bool outputs = false;     ///< a channel with a mistake begins at an unknown output
};

/// Reads `channels` into model.channels, fleets expanded. entry may be null.
///
/// Errors: E101 and E112 paths; E104 form; E207 and E208 types and units of the ends; E301 two sources;
///         E303 index; E304 the wrong end; E306 timeouts where nothing blocks; E307 index forms that do not
///         go together; E309 `send` or `receive` beside `model`, a model without its timeout.
/// Warnings: W310 an unusual direction.
[[nodiscard]] Excuses read_channels(const Entry* entry, const Types& types, const Groups& groups,
                                    Models& models, Model& model, Diagnostics& out);

}  // namespace tessera::spec
