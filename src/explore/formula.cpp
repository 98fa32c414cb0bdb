#include "explore/formula.hpp"

#include <algorithm>

namespace tessera::explore {

bool holds(const Formula& formula, const PtNet& net, std::span<const Tokens> marking) {
  const auto part_holds = [&](const Formula& part) { return holds(part, net, marking); };
  switch (formula.kind) {
    case Formula::Kind::at_least:
      return marking[formula.node] >= formula.tokens;
    case Formula::Kind::enabled:
      return net.enabled(formula.node, marking);
    case Formula::Kind::dead:
      for (std::uint32_t transition = 0; transition < net.transitions(); ++transition)
        if (net.enabled(transition, marking)) return false;
      return true;
    case Formula::Kind::negation:
      return !part_holds(formula.parts.front());
    case Formula::Kind::all:
      return std::ranges::all_of(formula.parts, part_holds);
    case Formula::Kind::any:
      return std::ranges::any_of(formula.parts, part_holds);
  }
  return false;
}

}  // namespace tessera::explore
