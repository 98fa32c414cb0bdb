#pragma once

#include "spec/document/document.hpp"

namespace tessera::spec {

/// Sets the span of a scalar (and of a null that is written out), and whether the file contains its text
/// verbatim. yaml-cpp only gives the position where a node begins, including its anchor and quotes.
///
/// begin:   the position that yaml-cpp gives.
/// Returns: false if the scalar opens a quote that nothing closes.
[[nodiscard]] bool locate_scalar(Node& node, const Span& begin, const Diagnostics& source);

/// The span that begins at `begin`, behind the anchor and the tag that may stand there.
[[nodiscard]] Span behind_anchor_and_tag(const Span& begin, const Diagnostics& source);

}  // namespace tessera::spec
