#pragma once

#include <vector>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads the behaviours of a subsystem whose buffers have been read.
///
/// Errors: E101 unknown behaviour, buffer or condition; E103 no behaviour; E105-E107
///         names; those of conditions.
[[nodiscard]] std::vector<Behaviour> read_behaviours(const Entry& entry, const std::vector<Field>& inputs,
                                                     const std::vector<Field>& outputs, Diagnostics& out);

}  // namespace tessera::spec
