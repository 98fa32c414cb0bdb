#pragma once

#include "spec/behaviours/defaults.hpp"
#include "spec/behaviours/group_templates.hpp"
#include "spec/document/document.hpp"
#include "spec/document/families.hpp"
#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {

/// The names that every subsystem sees.
struct SystemScope {
  const Types& types;
  const std::vector<Parameter>& parameters;  ///< of the system
  OnError* on_error = nullptr;               ///< of the agent, or else of the system; null: neither says it
  const FleetSizes* fleets = nullptr;        ///< null: the system has none
  GroupTemplates* groups = nullptr;          ///< null: the system has none
};

/// Reads the subsystem below `entry`, whose key is its name.
///
/// Errors: E101 unknown start or safe buffer; E103 no behaviours; E110 a key of another kind of subsystem;
///         E271, E275 `on_error`; those of buffers, parameters and behaviours. Warnings: W361 a default that nothing
///         uses.
[[nodiscard]] Subsystem read_subsystem(const Entry& entry, SubsystemKind kind, const SystemScope& around,
                                       Diagnostics& out);

/// "receptor"
[[nodiscard]] std::string_view name_of(SubsystemKind kind);

}  // namespace tessera::spec
