#include "verify/communication/blocks.hpp"

#include <algorithm>
#include <vector>

namespace tessera::verify {
namespace {

using net::Operation;
using net::PlaceId;

/// Which part of its channel's memory a fused place is; 0: none that we know.
std::uint8_t memory_of(const net::Place& place) {
  switch (place.role) {
    case PlaceRole::lock:
    case PlaceRole::sent_memory:
    case PlaceRole::received_memory:
      return free_to_use;
    case PlaceRole::empty:
      return empty;
    case PlaceRole::full:
      return full;
    case PlaceRole::acknowledged:
      return acknowledged;
    case PlaceRole::idle:
      return idle;
    case PlaceRole::sent:
      return sent;
    case PlaceRole::more:
      return more;
    default:
      return 0;
  }
}

/// The effect of a step, apart from the source of its token.
struct Move {
  PlaceId to;
  std::uint8_t takes, gives;
  bool elapsed = false;
  bool operator==(const Move&) const = default;
};

/// Do exactly these moves start at the place? Those that touch memory touch that of the channel.
bool moves_are(const Steps& steps, PlaceId from, net::ChannelId channel, std::span<const Move> expected) {
  const auto found = steps.from(from);
  if (found.size() != expected.size()) return false;
  return std::ranges::all_of(found, [&](const TokenStep& step) {
    const net::Condition& condition = steps.net()[step.id].condition;
    const bool elapsed = condition.kind == net::Condition::Kind::elapsed;
    if (!elapsed && condition.kind != net::Condition::Kind::none) return false;
    const bool here = step.channel == channel || (!step.channel.valid() && step.takes == 0);
    return step.from.valid() && here && !step.own_model &&
           std::ranges::count(expected, Move{step.to, step.takes, step.gives, elapsed}) == 1;
  });
}

/// Tries the forms of a block one after the other.
class Match {
 public:
  Match(const Steps& steps, PlaceId in) : steps_(steps), in_(in) {}

  std::optional<Block> result() {
    const auto starts = steps_.from(in_);
    // Every block has a transition into its working place, which carries the operation.
    const auto start = std::ranges::find_if(starts, [&](const TokenStep& step) {
      if (!step.to.valid()) return false;
      const Operation::Kind kind = steps_.net()[step.to].operation.kind;
      return kind == Operation::Kind::write || kind == Operation::Kind::read;
    });
    if (start == starts.end()) return std::nullopt;
    work_ = start->to;
    const Operation& operation = steps_.net()[work_].operation;
    channel_ = operation.channel;
    if (channel_.value >= steps_.channel_count() || steps_.from(work_).empty()) return std::nullopt;
    after_work_ = steps_.from(work_).front().to;
    if (!after_work_.valid()) return std::nullopt;
    const bool sends = operation.kind == Operation::Kind::write;
    if (exchanges()) return block(sends ? Side::send : Side::receive, false, false, after_work_);
    if (!sends) return receive();
    return steps_.networked(channel_) ? send_over_network() : send();
  }

 private:
  [[nodiscard]] bool moves(PlaceId from, std::initializer_list<Move> expected) const {
    return moves_are(steps_, from, channel_, {expected.begin(), expected.size()});
  }

  [[nodiscard]] bool exchanges() const {
    return moves(in_, {{work_, free_to_use, 0}}) && moves(work_, {{after_work_, 0, free_to_use}});
  }

  std::optional<Block> send() {
    if (!steps_.acknowledges(channel_)) {
      if (!moves(in_, {{work_, empty, 0}, {work_, full, 0}}) || !moves(work_, {{after_work_, 0, full}}))
        return std::nullopt;
      return block(Side::send, false, false, after_work_);
    }
    const PlaceId wait = after_work_;
    if (!moves(in_, {{work_, empty, 0}}) || !moves(work_, {{wait, 0, full}}) || steps_.from(wait).empty())
      return std::nullopt;
    const PlaceId out = steps_.from(wait).front().to;
    if (moves(wait, {{out, acknowledged, 0}})) return block(Side::send, true, false, out);
    if (moves(wait, {{out, acknowledged, 0}, {out, full, empty, true}}))
      return block(Side::send, true, true, out);
    return std::nullopt;
  }

  std::optional<Block> send_over_network() {
    const PlaceId wait = after_work_;
    const bool one_at_most = moves(work_, {{wait, idle, sent}});
    const bool several = moves(work_, {{wait, idle, sent}, {wait, sent, more}, {wait, more, more}});
    if (!moves(in_, {{work_, 0, 0}}) || (!one_at_most && !several)) return std::nullopt;
    const auto after = steps_.from(wait);
    const auto taken = std::ranges::find_if(after, [](const TokenStep& step) {
      return step.takes == (idle | empty) && step.gives == (idle | empty);
    });
    if (taken == after.end())
      return several ? std::optional(block(Side::send, false, false, wait)) : std::nullopt;
    const PlaceId out = taken->to;
    const Move end{out, idle | empty, idle | empty};
    if (one_at_most && moves(wait, {end})) return block(Side::send, true, false, out);
    if (several && moves(wait, {end,
                                {out, 0, 0, true},
                                {out, sent, idle, true},
                                {out, more, sent, true},
                                {out, idle | full, idle | empty, true}}))
      return block(Side::send, true, true, out);
    return std::nullopt;
  }

  std::optional<Block> receive() {
    const PlaceId out = after_work_;
    const std::uint8_t released = steps_.acknowledges(channel_) ? empty | acknowledged : empty;
    if (!moves(work_, {{out, 0, released}})) return std::nullopt;
    if (moves(in_, {{work_, full, 0}})) return block(Side::receive, true, false, out);
    if (moves(in_, {{work_, full, 0}, {out, empty, empty}})) return block(Side::receive, false, false, out);
    if (moves(in_, {{work_, full, 0}, {out, empty, empty, true}}))
      return block(Side::receive, true, true, out);
    return std::nullopt;
  }

  [[nodiscard]] Block block(Side side, bool blocking, bool timeout, PlaceId out) const {
    return {{.channel = channel_, .side = side, .blocking = blocking, .timeout = timeout}, out};
  }

  const Steps& steps_;
  PlaceId in_, work_, after_work_;
  net::ChannelId channel_;
};

/// Follows the transitions of one block from `in` to the only place that none of them leaves.
std::optional<Block> own_block_at(const Steps& steps, PlaceId in) {
  const auto starts = steps.from(in);
  if (starts.empty() || !starts.front().channel.valid()) return std::nullopt;
  Block block{.communication = {.channel = starts.front().channel, .own_model = true}, .out = {}};
  const net::BlockId id = steps.net()[starts.front().id].block;
  std::vector<PlaceId> reached{in};
  for (std::size_t at = 0; at < reached.size(); ++at) {
    bool left = false;
    for (const TokenStep& step : steps.from(reached[at])) {
      if (steps.net()[step.id].block != id) continue;
      const bool foreign = step.channel.valid() && step.channel != block.communication.channel;
      if (foreign || !step.from.valid() || !step.to.valid()) return std::nullopt;
      left = true;
      if (std::ranges::find(reached, step.to) == reached.end()) reached.push_back(step.to);
    }
    if (!left && block.out.valid()) return std::nullopt;
    if (!left) block.out = reached[at];
    if (steps.net()[reached[at]].operation.kind == Operation::Kind::read)
      block.communication.side = Side::receive;
  }
  return block.out.valid() ? std::optional(block) : std::nullopt;
}

}  // namespace

Steps::Steps(const net::Net& net) : net_(net), starts_(net.places().size() + 1, 0) {
  for (const net::Place& place : net.places()) {
    if (!place.fused()) continue;
    if (acknowledges_.size() <= place.channel.value) acknowledges_.resize(place.channel.value + 1, false);
    networked_.resize(acknowledges_.size(), false);
    if (is_networked(place.role)) networked_[place.channel.value] = true;
    if (memory_of(place) == acknowledged) acknowledges_[place.channel.value] = true;
  }
  std::vector<std::pair<PlaceId, TokenStep>> found;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    if (!net[id].subsystem.valid()) continue;
    const std::optional<TokenStep> step = read(id);
    if (!step) {
      stray_ = id;
      continue;
    }
    for (const net::Arc& arc : net.preset(id))
      if (!net[arc.place].fused()) found.emplace_back(arc.place, *step);
  }
  for (const auto& [place, step] : found) ++starts_[place.value + 1];
  for (std::size_t place = 1; place < starts_.size(); ++place) starts_[place] += starts_[place - 1];
  steps_.resize(found.size());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (const auto& [place, step] : found) steps_[next[place.value]++] = step;
}

std::optional<TokenStep> Steps::read(net::TransitionId id) {
  TokenStep step{.id = id, .from = {}, .to = {}};
  const auto gather = [&](std::span<const net::Arc> arcs, PlaceId& own, std::uint8_t& memory) {
    std::size_t owned = 0;
    for (const net::Arc& arc : arcs) {
      const net::Place& place = net_[arc.place];
      if (arc.weight != 1) return false;
      if (!place.fused()) {
        if (place.subsystem != net_[id].subsystem) return false;
        own = owned++ == 0 ? arc.place : PlaceId{};
        continue;
      }
      const std::uint8_t part = memory_of(place);
      if (step.channel.valid() && step.channel != place.channel) return false;
      step.own_model = step.own_model || part == 0;
      step.channel = place.channel;
      memory |= part;
    }
    return owned > 0;
  };
  if (!gather(net_.preset(id), step.from, step.takes)) return std::nullopt;
  if (!gather(net_.postset(id), step.to, step.gives)) return std::nullopt;
  return step;
}

bool may_be_skipped(const Steps& steps, PlaceId in) {
  return std::ranges::any_of(steps.from(in), [&](const TokenStep& step) {
    const net::Condition::Kind kind = steps.net()[step.id].condition.kind;
    return kind == net::Condition::Kind::send || kind == net::Condition::Kind::skip;
  });
}

std::optional<Block> block_at(const Steps& steps, PlaceId in) {
  // The structure knows no iteration that communicates less than another one of its behaviour.
  if (may_be_skipped(steps, in)) return std::nullopt;
  if (const std::optional<Block> block = Match(steps, in).result()) return block;
  return own_block_at(steps, in);
}

}  // namespace tessera::verify
