#include "spec/channels/channel_ends.hpp"

#include <array>
#include <set>
#include <string>

#include "diagnostics/utf8.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;
using Kind = Selector::Kind;

bool counts(const Selector& selector) {
  return selector.kind == Kind::variable || selector.kind == Kind::all;
}

/// An index of a channel, of an agent or of a buffer, that stands for several.
struct IndexRange {
  const Selector* selector;
  Span span;
  std::uint32_t count;
  std::string fleet;
  bool of_buffer;
};

std::vector<IndexRange> ranges_of(const WrittenEnd& end) {
  std::vector<IndexRange> ranges;
  if (counts(end.path.selector))
    ranges.push_back(
        {&end.path.selector, end.path.index_span, end.target.group->count, end.target.group->name, false});
  if (counts(end.path.member) && end.family)
    ranges.push_back({&end.path.member, end.path.member_span, end.family->count, end.family->fleet, true});
  return ranges;
}

bool check(const std::vector<IndexRange>& from, const std::vector<IndexRange>& to, Diagnostics& out) {
  std::vector<IndexRange> all = from;
  all.insert(all.end(), to.begin(), to.end());
  for (std::size_t at = 1; at < all.size(); ++at) {
    const IndexRange& first = all.front();
    const IndexRange& other = all[at];
    if (first.selector->kind == Kind::all || other.selector->kind == Kind::all) {
      out.error("E307", other.span, "'*' stands for every agent and may stand at one end only",
                "write [i] at both ends to join agents pair by pair");
      return false;
    }
    if (first.count == other.count) continue;
    if (first.of_buffer || other.of_buffer) {
      const IndexRange& buffer = other.of_buffer ? other : first;
      const IndexRange& agents = other.of_buffer ? first : other;
      out.error("E293", other.span,
                "the buffer is one for each " + buffer.fleet + " (" + std::to_string(buffer.count) +
                    "), and i counts over " + in_quotes(agents.fleet) + " (" + std::to_string(agents.count) +
                    ")",
                "declare it as one for each " + agents.fleet + ", or name the members by number");
      return false;
    }
    out.error("E307", other.span,
              "i counts over fleets of different sizes: " + std::to_string(first.count) + " and " +
                  std::to_string(other.count),
              "give both fleets the same count, or name the agents by number");
    return false;
  }
  return true;
}

/// The member that a selector of a buffer means for i; none past the end of the fleet.
std::optional<std::uint32_t> member_at(const WrittenEnd& end, std::int64_t i) {
  const Selector& selector = end.path.member;
  const std::int64_t number = selector.kind == Kind::constant   ? selector.number
                              : selector.kind == Kind::variable ? i + selector.number
                                                                : i;
  if (number < 0 || number >= std::int64_t{end.family->count}) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

std::optional<ExpandedEnd> end_at(const WrittenEnd& end, std::int64_t i) {
  const auto agent = agent_number(end.path.selector, *end.target.group, i);
  if (!agent) return std::nullopt;
  if (!end.family) return ExpandedEnd{*agent, end.buffer};
  const auto member = member_at(end, i);
  if (!member) return std::nullopt;
  return ExpandedEnd{*agent, BufferId{end.buffer.value + *member}};
}

}  // namespace

bool expand_channel(const WrittenEnd& from, const WrittenEnd& to, ChannelExpansion& into, Diagnostics& out) {
  const std::vector<IndexRange> sources = ranges_of(from), targets = ranges_of(to);
  if (!check(sources, targets, out)) return false;
  const std::int64_t count = !sources.empty()   ? sources.front().count
                             : !targets.empty() ? targets.front().count
                                                : 1;
  std::set<ExpandedEnd> fed;
  for (std::int64_t i = 0; i < count; ++i) {
    const auto source = end_at(from, i);
    const auto target = end_at(to, i);
    if (!source || !target) continue;
    into.pairs.emplace_back(*source, *target);
    fed.insert(*target);
  }
  // Every end that some number of i stands for is meant.
  const std::int64_t meant = targets.empty() ? 1 : targets.front().count;
  for (std::int64_t i = 0; i < meant; ++i) {
    // Also those that only an offset leaves out: robot[i] -> robot[i+1] means that the first has a source, too.
    WrittenEnd plain = to;
    if (plain.path.selector.kind == Kind::variable) plain.path.selector.number = 0;
    if (plain.path.member.kind == Kind::variable) plain.path.member.number = 0;
    const auto target = end_at(plain, i);
    if (target && !fed.contains(*target)) into.dropped.push_back(*target);
  }
  return true;
}

}  // namespace tessera::spec
