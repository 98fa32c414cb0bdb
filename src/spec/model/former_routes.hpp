#pragma once

#include <optional>
#include <string>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

/// Earlier versions let an entry of `next` that names no error take errors and failures, too. Nothing else in
/// Tessera knows that rule.
namespace tessera::spec {

/// A former way of errors and failures that endings.hpp takes elsewhere.
struct FormerRoute {
  NextId before;        ///< the first entry that could take them: `{ to, when: error }` belongs before it
  bool certain = true;  ///< false: a condition decided where they led
  BehaviourId to{};     ///< if certain; invalid: `end`
  bool no_terminal =
      false;  ///< the behaviour never ends as terminal, and `before` is its only entry: of no use now
};

/// nullopt: each error and failure leads where it has led, or `on_error`, which earlier versions did not have, leads
/// the behaviour's failures or leads to it.
[[nodiscard]] std::optional<FormerRoute> former_route(const Subsystem& subsystem, const Behaviour& behaviour);

/// Notes: N330 a failure of behaviours no longer leads on, N332 entries with conditions no longer take
/// errors that a later entry names; of each at most one for each subsystem. N330 leaves out behaviours whose
/// `terminal` is `true`, and those that W313 and W315 are about.
void note_former_routes(const Model& model, diagnostics::Diagnostics& out);

}  // namespace tessera::spec
