#pragma once

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Warns of communication that cannot do what it seems to be for.
///
/// Warnings: W371 a condition asks an input that its behaviour never receives; W372 an effector whose `stale` is
///           shorter than the waits of a behaviour between two values for it.
void check_waits(const Model& model, Diagnostics& out);

}  // namespace tessera::spec
