#pragma once

#include <string_view>
#include <vector>

#include "spec/document/document.hpp"

namespace tessera::spec {

/// The positions of a scalar's bytes in the file, also if the text takes several lines or has escapes.
class Positions {
 public:
  Positions(const Node& text, const Diagnostics& source);

  /// The span of `length` bytes from `offset`, at most to the end of their line; the span of the whole scalar
  /// if the text is not in the file as YAML gives it.
  [[nodiscard]] Span part(std::size_t offset, std::size_t length) const;

 private:
  /// Follows the text and the file together. false: they differ by more than blanks and escapes.
  [[nodiscard]] bool align(const Diagnostics& source);

  const Node& text_;
  std::vector<Span> bytes_;  ///< of text_, where it is not `verbatim`; empty: unknown
};

}  // namespace tessera::spec
