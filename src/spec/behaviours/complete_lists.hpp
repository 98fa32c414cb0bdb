#pragma once

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Warns of lists `next` that ask what is known (memory with few values, what the last communication has shown), if
/// they are incomplete: for some answers together, no entry holds after a terminal ending. check_behaviour_flow does
/// so for all other lists. A value that came may be invalid, and then it is not fresh.
///
/// Warnings: W312.
void check_complete_lists(const Model& model, diagnostics::Diagnostics& out);

/// Whether an entry of the list asks for something that is known.
[[nodiscard]] bool asks_what_is_known(const Behaviour& behaviour);

}  // namespace tessera::spec
