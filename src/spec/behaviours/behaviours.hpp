#pragma once

#include <optional>
#include <vector>

#include "spec/behaviours/defaults.hpp"
#include "spec/behaviours/group_templates.hpp"
#include "spec/conditions/scope.hpp"
#include "spec/document/document.hpp"
#include "spec/document/families.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// The behaviours and groups of a subsystem, each group before what is in it.
struct ReadBehaviours {
  std::vector<Behaviour> behaviours;
  std::vector<std::optional<OnError>> on_error;  ///< per behaviour, of groups
};

/// Reads the behaviours of a subsystem. Everything that `scope` refers to has been read.
///
/// A behaviour `for: each robot` becomes one for each member, which follow one another.
///
/// Their `next` is as in the file, without what `on_error` adds, and without implied entries.
/// Errors: E101 unknown behaviour, buffer or condition; E103 no behaviour; E105-E107
///         names; E291 an entry for each member without a condition of its own; E349 `for` of a group, or in one; those
///         of conditions, of lists of buffers, of groups and their templates, and of read_each and number_of
///         (families.hpp).
[[nodiscard]] ReadBehaviours read_behaviours(const Entry& entry, const ConditionScope& scope,
                                             SubsystemDefaults& defaults, const FleetSizes* fleets,
                                             GroupTemplates* groups, Diagnostics& out);

}  // namespace tessera::spec
