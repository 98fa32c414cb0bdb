#include "spec/channels/channel_ends.hpp"

#include "diagnostics/utf8.hpp"

namespace tessera::spec {
namespace {

using Kind = Selector::Kind;

std::optional<std::uint32_t> number_at(const WrittenEnd& end, std::int64_t i) {
  return agent_number(end.path.selector, *end.target.group, i);
}

bool ranges(const WrittenEnd& end) {
  return end.path.selector.kind == Kind::variable || end.path.selector.kind == Kind::all;
}

bool check(const WrittenEnd& from, const WrittenEnd& to, Diagnostics& out) {
  if (!ranges(from) || !ranges(to)) return true;
  if (from.path.selector.kind == Kind::all || to.path.selector.kind == Kind::all) {
    out.error("E307", to.path.index_span, "'*' stands for every agent and may stand at one end only",
              "write [i] at both ends to join agents pair by pair");
    return false;
  }
  if (from.target.group->count != to.target.group->count) {
    out.error("E307", to.path.index_span,
              "i counts over fleets of different sizes: " + std::to_string(from.target.group->count) +
                  " and " + std::to_string(to.target.group->count),
              "give both fleets the same count, or name the agents by number");
    return false;
  }
  return true;
}

}  // namespace

bool expand_channel(const WrittenEnd& from, const WrittenEnd& to, ChannelExpansion& into, Diagnostics& out) {
  if (!check(from, to, out)) return false;
  const std::int64_t count = ranges(from) ? from.target.group->count
                             : ranges(to) ? to.target.group->count
                                          : 1;
  std::vector<bool> fed(to.target.group->count, false);
  for (std::int64_t i = 0; i < count; ++i) {
    const auto source = number_at(from, i);
    const auto target = number_at(to, i);
    if (!source || !target) continue;
    into.pairs.emplace_back(*source, *target);
    fed[*target] = true;
  }
  for (std::uint32_t target = 0; target < fed.size(); ++target) {
    const bool meant = ranges(to) || target == number_at(to, 0);
    if (meant && !fed[target]) into.dropped.push_back(target);
  }
  return true;
}

}  // namespace tessera::spec
