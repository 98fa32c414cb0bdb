// Chains over something that is not of the system.
#include <algorithm>

#include "timing/declared.hpp"

namespace tessera::timing {

std::vector<Chain> parts_of(const Chain& way, const std::vector<ForeignHop>& foreign) {
  std::vector<Chain> parts;
  std::size_t first = 0;
  const auto add = [&](std::size_t end) {
    parts.emplace_back(way.begin() + static_cast<std::ptrdiff_t>(first),
                       way.begin() + static_cast<std::ptrdiff_t>(end));
    first = end;
  };
  for (const ForeignHop& hop : foreign) add(hop.after);
  add(way.size());
  return parts;
}

/// A reading is the base of the command in force until a newer command is given, and of the answer that is there until
/// the newer answer comes. In that time the next receptor reads it, which begins a chain of its own. An answer is an
/// event at the device of that receptor.
ChainBound bound_of(const Bounds& bounds, const Chain& way, const std::vector<ForeignHop>& foreign) {
  if (foreign.empty()) return bounds.chain(way);
  const std::vector<Chain> parts = parts_of(way, foreign);
  ChainBound all{0, 0, 0, false};
  for (std::size_t at = 0; at < parts.size(); ++at) {
    const ChainBound part = bounds.chain(parts[at]);
    const bool is_last = at + 1 == parts.size();
    const Time answer = is_last ? 0 : foreign[at].longest;
    all.age = plus(all.age, plus(is_last ? part.age : part.reaction, answer));
    all.reaction = plus(all.reaction, plus(part.reaction, answer));
    all.start = plus(all.start, plus(at == 0 ? part.start : std::max(part.start, part.reaction), answer));
  }
  return all;
}

}  // namespace tessera::timing
