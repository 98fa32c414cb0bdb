#include "replay/joint_play.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "replay/net_play.hpp"

namespace tessera::replay {

using net::Arc;
using net::ChannelId;
using net::TransitionId;
using Kind = JointPlay::Obstacle::Kind;
using Reason = JointPlay::Obstacle::Reason;
using Move = DeployedNet::Move;

JointPlay::JointPlay(const DeployedNet& net, std::vector<Start> starts, bool one_run)
    : net_(net),
      starts_(std::move(starts)),
      assumed_(starts_.size(), false),
      of_process_(net.process_count()),
      marking_(net::initial_marking(net.net())),
      after_start_(marking_),
      versions_(net.channel_count(), 0),
      links_(net.channel_count()) {
  for (const StartId start : starts_.ids()) {
    std::vector<StartId>& all = of_process_[starts_[start].process];
    ordinals_.push_back(static_cast<std::uint32_t>(all.size()));
    all.push_back(start);
  }
  for (std::uint32_t index = 0; index < links_.size(); ++index)
    if (net_[ChannelId{index}].networked) link_up({index}, one_run);
  if (net_.start().valid()) net::fire(net_.net(), net_.start(), after_start_);
}

void JointPlay::link_up(ChannelId id, bool one_run) {
  const DeployedNet::Channel& channel = net_[id];
  Link& link = links_[id.value];
  // A side that no behaviour uses has no process.
  const auto starts = [&](ProcessId process) {
    return process.valid() ? of_process_[process] : std::vector<StartId>();
  };
  const std::vector<StartId> senders = starts(channel.sending), receivers = starts(channel.receiving);
  link.sending.resize(senders.size());
  link.receiving.resize(receivers.size());
  link.tracked = (!channel.sending.valid() || senders.size() == 1) &&
                 (!channel.receiving.valid() || receivers.size() == 1);
  if (one_run && !senders.empty() && !receivers.empty()) {
    link.sending.front().peer = receivers.front();
    link.receiving.front().peer = senders.front();
  }
  std::uint64_t initial = 0;
  for (std::size_t place = 0; place < channel.places.size(); ++place)
    initial |= std::uint64_t{marking_[channel.places[place].value]} << place;
  link.markings = with_medium(id, std::uint64_t{1} << initial);
}

void JointPlay::start_system() { marking_ = after_start_; }

void JointPlay::restart(StartId start) {
  const ProcessId process = starts_[start].process;
  for (std::uint32_t place = 0; place < marking_.size(); ++place)
    if (net_.process_of({place}) == process) marking_[place] = after_start_[place];
  for (std::uint32_t channel = 0; channel < versions_.size(); ++channel)
    if (!net_[ChannelId{channel}].networked && net_[ChannelId{channel}].sending == process)
      versions_[channel] = 0;
}

JointPlay::Sending& JointPlay::sending(ChannelId channel, StartId start) {
  return links_[channel.value].sending[ordinals_[start]];
}
const JointPlay::Sending& JointPlay::sending(ChannelId channel, StartId start) const {
  return links_[channel.value].sending[ordinals_[start]];
}
JointPlay::Receiving& JointPlay::receiving(ChannelId channel, StartId start) {
  return links_[channel.value].receiving[ordinals_[start]];
}
const JointPlay::Receiving& JointPlay::receiving(ChannelId channel, StartId start) const {
  return links_[channel.value].receiving[ordinals_[start]];
}

// --------------------------------------------------------------------------------------------- obstacles

JointPlay::Obstacle JointPlay::obstacle(const Firing& firing) const {
  const DeployedNet::Transition& transition = net_[firing.transition];
  Obstacle found;
  if (transition.step != ChannelStep::none)
    found = number_obstacle(firing);
  else if (transition.channel.valid() || firing.version != 0)
    found = version_obstacle(firing);
  return found.kind == Kind::no ? token_obstacle(firing) : found;
}

JointPlay::Obstacle JointPlay::token_obstacle(const Firing& firing) const {
  for (const Arc& arc : net_.net().preset(firing.transition)) {
    if (net_.is_hidden(arc.place) || net::suffices(marking_, arc)) continue;
    // All firings of a local channel up to this one have been played, and so have those of its own subsystem.
    const net::SubsystemId subsystem = net_.net()[firing.transition].subsystem;
    const bool own =
        net_.net()[arc.place].fused() || (subsystem.valid() && net_.is_made_by(arc.place, subsystem));
    return {.kind = own ? Kind::never : Kind::waits, .place = arc.place, .awaited = firing.start};
  }
  return {};
}

JointPlay::Obstacle JointPlay::version_obstacle(const Firing& firing) const {
  const ChannelId channel = net_[firing.transition].channel;
  if (!channel.valid() || firing.version == 0) return {.kind = Kind::never, .reason = Reason::no_number};
  const std::uint32_t last = versions_[channel.value], due = last == UINT32_MAX ? 1 : last + 1;
  if (firing.version == due) return {};
  return {.kind = is_before(firing.version, due) ? Kind::never : Kind::waits,
          .reason = Reason::version,
          .due = due,
          .awaited = firing.start};
}

JointPlay::Obstacle JointPlay::number_obstacle(const Firing& firing) const {
  const DeployedNet::Transition& transition = net_[firing.transition];
  const auto must_be = [&](std::uint32_t due) -> Obstacle {
    if (firing.version == due) return {};
    return {.kind = Kind::never, .reason = Reason::number, .due = due};
  };
  const ChannelId channel = transition.channel;
  switch (transition.step) {
    case ChannelStep::none:
      return {};
    case ChannelStep::begins_write:
    case ChannelStep::writes:
      return must_be(sending(channel, firing.start).written + 1);
    case ChannelStep::gives_up:
      return must_be(transition.carries_number ? sending(channel, firing.start).written : 0);
    case ChannelStep::is_acknowledged:
      return acknowledgement_obstacle(firing);
    case ChannelStep::begins_read:
      return read_obstacle(firing, net_[channel].exchange);
    case ChannelStep::ends_read:
      return must_be(receiving(channel, firing.start).last);
    case ChannelStep::skips:
      return must_be(0);
  }
  return {};
}

JointPlay::Obstacle JointPlay::acknowledgement_obstacle(const Firing& firing) const {
  const ChannelId channel = net_[firing.transition].channel;
  const Sending& side = sending(channel, firing.start);
  if (firing.version != side.written)
    return {.kind = Kind::never, .reason = Reason::number, .due = side.written};
  if (!side.peer.valid()) return {.kind = Kind::never, .reason = Reason::no_peer};
  if (side.peer == unknown) return {};
  if (is_read_later(firing, side)) return {.kind = Kind::never, .reason = Reason::taken_already};
  const auto read = std::ranges::find(side.reads, side.peer, &Read::start);
  if (read != side.reads.end() && read->ended == firing.version) return {};
  if (assumed_[side.peer]) return {};
  return {.kind = Kind::waits, .reason = Reason::untaken, .awaited = side.peer};
}

JointPlay::Obstacle JointPlay::read_obstacle(const Firing& firing, bool exchange) const {
  const ChannelId channel = net_[firing.transition].channel;
  const Receiving& side = receiving(channel, firing.start);
  const std::uint32_t number = firing.version;
  if (number == 0 && exchange && side.last == 0 && side.peer_incarnation == 0) return {};
  if (number == 0) return {.kind = Kind::never, .reason = Reason::no_number};
  if (!side.peer.valid()) return {.kind = Kind::never, .reason = Reason::no_peer};
  if (side.last != 0 && (is_before(number, side.last) || (number == side.last && !exchange)))
    return {.kind = Kind::never, .reason = Reason::read_already, .due = side.last};
  if (was_left_behind(channel, firing, side)) return {.kind = Kind::never, .reason = Reason::taken_already};
  if (side.peer == unknown || assumed_[side.peer]) return {};
  if (!is_before(sending(channel, side.peer).written, number)) return {};
  return {.kind = Kind::waits, .reason = Reason::unwritten, .awaited = side.peer};
}

/// An earlier start of the reader took a newer value, or told the sender that it had taken this one. The first
/// read of a start decides, since the numbers of its reads grow.
bool JointPlay::was_left_behind(ChannelId channel, const Firing& firing, const Receiving& side) const {
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
bool JointPlay::is_read_later(const Firing& firing, const Sending& side) const {
  return std::ranges::any_of(side.reads, [&](const Read& read) {
    return ordinals_[read.start] > ordinals_[side.peer] && !is_before(firing.version, read.first);
  });
}

std::string JointPlay::complaint(const Firing& firing, const Obstacle& obstacle) const {
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

// ------------------------------------------------------------------------------------------------- firing

std::optional<Problem> JointPlay::fire(const Firing& firing) {
  const TransitionId id = firing.transition;
  for (const Arc& arc : net_.net().preset(id))
    if (!net_.is_hidden(arc.place)) marking_[arc.place.value] -= arc.weight;
  for (const Arc& arc : net_.net().postset(id)) {
    if (net_.is_hidden(arc.place)) continue;
    marking_[arc.place.value] += arc.weight;
    if (marking_[arc.place.value] > 1)
      return Problem{
          fmt::format("'{}' puts a second token into '{}'", net_.net()[id].name, net_.net()[arc.place].name)};
  }
  if (net_[id].step != ChannelStep::none) {
    stop_tracking(firing);
    if (!move_markings(firing))
      return Problem{fmt::format("'{}' fired, but no marking of '{}' allows it", net_.net()[id].name,
                                 net_.net().parts()[net_[id].channel])};
    count(firing);
  } else if (net_[id].channel.valid()) {
    versions_[net_[id].channel.value] = firing.version;
  }
  ++firings_;
  return std::nullopt;
}

/// A firing that needs what is not recorded: the markings after that are not known.
void JointPlay::stop_tracking(const Firing& firing) {
  const ChannelId channel = net_[firing.transition].channel;
  const DeployedNet::Channel& ends = net_[channel];
  const bool sends = starts_[firing.start].process == ends.sending;
  const StartId peer = sends ? sending(channel, firing.start).peer : receiving(channel, firing.start).peer;
  if (is_given(peer) && assumed_[peer]) links_[channel.value].tracked = false;
}

/// nullptr: the sender is not given.
JointPlay::Read* JointPlay::read_by(const Firing& firing) {
  const ChannelId channel = net_[firing.transition].channel;
  const StartId sender = receiving(channel, firing.start).peer;
  if (!is_given(sender)) return nullptr;
  std::vector<Read>& reads = sending(channel, sender).reads;
  if (reads.empty() || reads.back().start != firing.start) reads.push_back({.start = firing.start});
  return &reads.back();
}

void JointPlay::count(const Firing& firing) {
  const ChannelId channel = net_[firing.transition].channel;
  switch (net_[firing.transition].step) {
    case ChannelStep::writes:
      sending(channel, firing.start).written = firing.version;
      break;
    case ChannelStep::begins_read:
      receiving(channel, firing.start).last = firing.version;
      if (Read* read = read_by(firing); read != nullptr && read->first == 0) read->first = firing.version;
      break;
    case ChannelStep::ends_read:
      if (Read* read = read_by(firing); read != nullptr) read->ended = firing.version;
      break;
    case ChannelStep::is_acknowledged:
      sending(channel, firing.start).acknowledged = firing.version;
      break;
    case ChannelStep::none:
    case ChannelStep::begins_write:
    case ChannelStep::gives_up:
    case ChannelStep::skips:
      break;
  }
}

bool JointPlay::move_markings(const Firing& firing) {
  const DeployedNet::Transition& transition = net_[firing.transition];
  Link& link = links_[transition.channel.value];
  if (!link.tracked) return true;
  std::uint64_t after = 0;
  for (std::uint64_t left = link.markings; left != 0; left &= left - 1) {
    const auto marking = static_cast<std::uint32_t>(std::countr_zero(left));
    for (const Move& move : transition.moves)
      if ((marking & move.takes) == move.takes)
        after |= std::uint64_t{1} << ((marking & ~move.takes) | move.gives);
  }
  link.markings = with_medium(transition.channel, after);
  return link.markings != 0;
}

/// Whatever the medium may do meanwhile, it may have done.
std::uint64_t JointPlay::with_medium(ChannelId channel, std::uint64_t markings) const {
  std::uint64_t all = markings;
  for (std::uint64_t fresh = markings; fresh != 0;) {
    const auto marking = static_cast<std::uint32_t>(std::countr_zero(fresh));
    fresh &= fresh - 1;
    for (const Move& move : net_[channel].medium) {
      if ((marking & move.takes) != move.takes) continue;
      const std::uint64_t next = std::uint64_t{1} << ((marking & ~move.takes) | move.gives);
      fresh |= next & ~all;
      all |= next;
    }
  }
  return all;
}

// -------------------------------------------------------------------------------------------------- peers

JointPlay::StartId JointPlay::find_start(ProcessId process, std::uint64_t incarnation) const {
  for (const StartId start : of_process_[process])
    if (starts_[start].incarnation == incarnation) return start;
  return unknown;
}

/// false: it is an earlier one.
bool JointPlay::turn(Sending& side, StartId peer, std::uint64_t incarnation) const {
  if (incarnation <= side.peer_incarnation) return false;
  side.peer = peer;
  side.peer_incarnation = incarnation;
  side.acknowledged = 0;
  return true;
}

bool JointPlay::turn(ChannelId channel, StartId start, StartId peer, std::uint64_t incarnation) {
  std::vector<Receiving>& all = links_[channel.value].receiving;
  Receiving& side = receiving(channel, start);
  const bool goes_back =
      incarnation <= side.peer_incarnation ||
      std::any_of(all.begin(), all.begin() + ordinals_[start],
                  [&](const Receiving& before) { return before.peer_incarnation > incarnation; });
  if (!goes_back) side = {.last = 0, .peer = peer, .peer_incarnation = incarnation};
  return !goes_back;
}

std::optional<Problem> JointPlay::hear(ChannelId channel, StartId start, std::uint64_t incarnation) {
  const DeployedNet::Channel& ends = net_[channel];
  const std::string& name = net_.net().parts()[channel];
  const ProcessId process = starts_[start].process;
  if (!ends.networked || (process != ends.sending && process != ends.receiving))
    return Problem{fmt::format("'{}' does not join this process with another", name)};
  const bool sends = process == ends.sending;
  const ProcessId other = sends ? ends.receiving : ends.sending;
  if (!other.valid()) return Problem{fmt::format("no process is at the other end of '{}'", name)};
  const StartId peer = find_start(other, incarnation);
  const bool forwards =
      sends ? turn(sending(channel, start), peer, incarnation) : turn(channel, start, peer, incarnation);
  if (!forwards)
    return Problem{fmt::format("at '{}' it turns back to an earlier start of the other process", name)};
  if (peer == unknown) {
    links_[channel.value].tracked = false;
    unknown_peer_ = fmt::format("incarnation {} at the other end of '{}'", incarnation, name);
  }
  return std::nullopt;
}

}  // namespace tessera::replay
