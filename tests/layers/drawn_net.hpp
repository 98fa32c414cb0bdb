#pragma once

#include <string>
#include <vector>

#include "net/net.hpp"
#include "oracle/nets/petri_net.hpp"

namespace tessera::test {

/// The token game on the drawn nets, never flattened. A fused place is one counter of tokens; a page has
/// none: what enters a page enters the input place of its net. Conditions are free choices.
struct DrawnNet {
  oracle::PetriNet game;           ///< its places are the counters
  std::vector<std::string> names;  ///< of the counters, as the flat net has them
};
[[nodiscard]] DrawnNet drawn_net(const net::HierarchicalNet& net);

}  // namespace tessera::test
