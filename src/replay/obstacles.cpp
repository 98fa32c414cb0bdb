#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "replay/net_play.hpp"
#include "replay/source.hpp"

namespace tessera::replay {

using net::Arc;
using net::ChannelId;
using Kind = NetPlay::Obstacle::Kind;
using Reason = NetPlay::Obstacle::Reason;

NetPlay::Obstacle NetPlay::obstacle(const Firing& firing) const {
  const DeployedNet::Transition& transition = net_[firing.transition];
  Obstacle found;
  if (transition.effect != ChannelEffect::none)
    found = number_obstacle(firing);
  else if (transition.channel.valid() || firing.version != 0)
    found = version_obstacle(firing);
  return found.kind == Kind::no ? token_obstacle(firing) : found;
}

NetPlay::Obstacle NetPlay::token_obstacle(const Firing& firing) const {
  for (const Arc& arc : net_.net().preset(firing.transition)) {
    if (net_.is_hidden(arc.place) || net::suffices(marking_, arc)) continue;
    // All firings of a local channel up to this one have been played, and so have those of its own subsystem.
    const ChannelId channel = net_.net()[arc.place].channel;
    const bool own = net_.net()[arc.place].fused()
                         ? versions_[channel.value].is == Version::known
                         : net_.is_made_by(arc.place, net_.net()[firing.transition].subsystem);
    return {.kind = own ? Kind::never : Kind::waits, .place = arc.place, .awaited = firing.start};
  }
  return {};
}

NetPlay::Obstacle NetPlay::version_obstacle(const Firing& firing) const {
  const ChannelId channel = net_[firing.transition].channel;
  if (!channel.valid() || firing.version == 0) return {.kind = Kind::never, .reason = Reason::no_number};
  const std::uint32_t due = versions_[channel.value].due();
  if (firing.version == due || lacks_version(channel)) return {};
  return {.kind = is_before(firing.version, due) ? Kind::never : Kind::waits,
          .reason = Reason::version,
          .due = due,
          .awaited = firing.start};
}

NetPlay::Obstacle NetPlay::number_obstacle(const Firing& firing) const {
  const DeployedNet::Transition& transition = net_[firing.transition];
  const auto must_be = [&](std::uint32_t due) -> Obstacle {
    if (firing.version == due) return {};
    return {.kind = Kind::never, .reason = Reason::number, .due = due};
  };
  const ChannelId channel = transition.channel;
  switch (transition.effect) {
    case ChannelEffect::none:
      return {};
    case ChannelEffect::begins_write:
    case ChannelEffect::writes:
      if (const Sending& side = sending(channel, firing.start); side.known) return must_be(side.written + 1);
      return {};
    case ChannelEffect::gives_up:
      if (!transition.carries_number) return must_be(0);
      if (const Sending& side = sending(channel, firing.start); side.known) return must_be(side.written);
      return {};
    case ChannelEffect::is_acknowledged:
      return acknowledgement_obstacle(firing);
    case ChannelEffect::begins_read:
      return read_obstacle(firing, net_[channel].exchange);
    case ChannelEffect::ends_read:
      if (const Receiving& side = receiving(channel, firing.start); side.known) return must_be(side.last);
      return {};
    case ChannelEffect::skips:
      return must_be(0);
  }
  return {};
}

NetPlay::Obstacle NetPlay::acknowledgement_obstacle(const Firing& firing) const {
  const ChannelId channel = net_[firing.transition].channel;
  const Sending& side = sending(channel, firing.start);
  if (!side.known) return {};
  if (firing.version != side.written)
    return {.kind = Kind::never, .reason = Reason::number, .due = side.written};
  if (!side.peer.valid()) return {.kind = Kind::never, .reason = Reason::no_peer};
  if (side.peer == not_given) return {};
  if (is_read_later(firing, side)) return {.kind = Kind::never, .reason = Reason::taken_already};
  const auto read = std::ranges::find(side.reads, side.peer, &Read::start);
  if (read != side.reads.end() && read->ended == firing.version) return {};
  if (assumed_[side.peer] || !receiving(channel, side.peer).known) return {};
  return {.kind = Kind::waits, .reason = Reason::untaken, .awaited = side.peer};
}

NetPlay::Obstacle NetPlay::read_obstacle(const Firing& firing, bool exchange) const {
  const ChannelId channel = net_[firing.transition].channel;
  const Receiving& side = receiving(channel, firing.start);
  const std::uint32_t number = firing.version;
  if (number == 0 && exchange && side.last == 0 && side.peer_incarnation == 0) return {};
  if (!side.known && (number != 0 || exchange)) return {};
  if (number == 0) return {.kind = Kind::never, .reason = Reason::no_number};
  if (!side.peer.valid()) return {.kind = Kind::never, .reason = Reason::no_peer};
  if (side.last != 0 && (is_before(number, side.last) || (number == side.last && !exchange)))
    return {.kind = Kind::never, .reason = Reason::read_already, .due = side.last};
  if (was_left_behind(channel, firing, side)) return {.kind = Kind::never, .reason = Reason::taken_already};
  if (side.peer == not_given || assumed_[side.peer] || !sending(channel, side.peer).known) return {};
  if (!is_before(sending(channel, side.peer).written, number)) return {};
  return {.kind = Kind::waits, .reason = Reason::unwritten, .awaited = side.peer};
}

/// An earlier start of the reader took a newer value, or told the sender that it had taken this one. The first
/// read of a start decides, since the numbers of its reads grow.
bool NetPlay::was_left_behind(ChannelId channel, const Firing& firing, const Receiving& side) const {
  const std::uint32_t ordinal = ordinals_[firing.start];
  if (ordinal == 0 || side.last != 0) return false;
  if (is_given(side.peer)) {
    const Sending& sender = sending(channel, side.peer);
    if (sender.acknowledged != 0 && is_given(sender.peer) && ordinals_[sender.peer] < ordinal &&
        !is_before(sender.acknowledged, firing.version))
      return true;
  }
  const std::vector<Receiving>& all = links_[channel.value].receiving;
  return std::any_of(all.begin(), all.begin() + ordinal, [&](const Receiving& before) {
    return before.peer_incarnation == side.peer_incarnation && before.last != 0 &&
           is_before(firing.version, before.last);
  });
}

/// A later start of the reader has read the value that an earlier one acknowledges.
bool NetPlay::is_read_later(const Firing& firing, const Sending& side) const {
  return std::ranges::any_of(side.reads, [&](const Read& read) {
    return ordinals_[read.start] > ordinals_[side.peer] && !is_before(firing.version, read.first);
  });
}

std::string NetPlay::complaint(const Firing& firing, const Obstacle& obstacle) const {
  const DeployedNet::Transition& transition = net_[firing.transition];
  const auto channel = [&] { return "'" + net_.net().parts()[transition.channel] + "'"; };
  std::string why;
  switch (obstacle.reason) {
    case Reason::token:
      why = fmt::format("'{}' holds no token", net_.net()[obstacle.place].name);
      break;
    case Reason::version:
      why = fmt::format("it is version {} of its channel, of which {} is due", firing.version, obstacle.due);
      break;
    case Reason::number:
      why = fmt::format("it carries number {} of {}, of which {} is due", firing.version, channel(),
                        obstacle.due);
      break;
    case Reason::no_number:
      why = "it is recorded with the wrong kind of version";
      break;
    case Reason::read_already:
      why = fmt::format("it reads value {} of {} after value {}", firing.version, channel(), obstacle.due);
      break;
    case Reason::taken_already:
      why = fmt::format("value {} of {} was taken before a restart, and is read again after it",
                        firing.version, channel());
      break;
    case Reason::no_peer:
      why = fmt::format("the recording does not say which start of the other process it hears at {}",
                        channel());
      break;
    case Reason::unwritten:
      why = fmt::format("value {} of {} is not written before it is read", firing.version, channel());
      break;
    case Reason::untaken:
      why = fmt::format("value {} of {} is not taken before that", firing.version, channel());
      break;
  }
  return fmt::format("'{}' fired, but {}", net_.net()[firing.transition].name, why);
}

}  // namespace tessera::replay
