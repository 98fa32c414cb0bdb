#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "net/net.hpp"

namespace tessera::test {

/// What an exhaustive search over all markings of a flat net says, by the definitions of
/// docs/verification.md.
struct NaiveAnswers {
  std::size_t markings = 0;
  std::vector<bool>
      stuck;  ///< per subsystem: from some marking it fires nothing ever again though it has not ended
  std::vector<bool>
      dry;  ///< per channel: from some marking it is never read again though its reader has not ended
  std::vector<bool> reader_can_end;  ///< per channel
  bool deadlock = false;             ///< some dead marking is not final
};

/// nullopt if there are more markings than that. Safe nets only.
[[nodiscard]] std::optional<NaiveAnswers> explore_naively(const net::Net& net, std::size_t most_markings);

}  // namespace tessera::test
