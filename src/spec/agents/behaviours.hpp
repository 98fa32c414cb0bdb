#pragma once

#include <vector>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// The behaviours of a subsystem whose buffers were read.
///
/// Errors: E101 unknown behaviour, buffer or condition; E103 none at all; E105-E107 names; those of
/// conditions.
[[nodiscard]] std::vector<Behaviour> read_behaviours(const Entry& entry, const std::vector<Field>& inputs,
                                                     const std::vector<Field>& outputs, Diagnostics& out);

}  // namespace tessera::spec
