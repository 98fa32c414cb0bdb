#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "net/net.hpp"

namespace tessera::test {

/// The result of a search over all markings of a flat net, by the definitions of docs/theory/verification.md.
struct NaiveAnswers {
  std::size_t markings = 0;
  /// Per subsystem: from some marking on it never fires again, although it has not ended.
  std::vector<bool> stuck;
  /// Per channel: from some marking on it is never read again, although its reader has not ended.
  std::vector<bool> dry;
  std::vector<bool> reader_can_end;  ///< per channel
  bool deadlock = false;             ///< some dead marking is not final
};

/// nullopt if there are more markings than that. Safe nets only.
[[nodiscard]] std::optional<NaiveAnswers> explore_naively(const net::Net& net, std::size_t most_markings);

}  // namespace tessera::test
