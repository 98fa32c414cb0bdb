#include "replay/net_play.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "replay/source.hpp"

namespace tessera::replay {

using net::Arc;
using net::ChannelId;
using net::TransitionId;
using Move = DeployedNet::Move;

NetPlay::NetPlay(const DeployedNet& net, std::vector<Start> starts, bool one_run)
    : net_(net),
      starts_(std::move(starts)),
      assumed_(starts_.size(), false),
      of_process_(net.process_count()),
      marking_(net::initial_marking(net.net())),
      after_start_(marking_),
      versions_(net.channel_count()),
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

void NetPlay::link_up(ChannelId id, bool one_run) {
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
  link.fixed_peers = one_run && senders.size() == 1 && receivers.size() == 1;
  if (link.fixed_peers) {
    link.sending.front().peer = receivers.front();
    link.receiving.front().peer = senders.front();
  }
  std::uint64_t initial = 0;
  for (std::size_t place = 0; place < channel.places.size(); ++place)
    initial |= std::uint64_t{marking_[channel.places[place].value]} << place;
  link.initial = link.markings = with_medium(id, std::uint64_t{1} << initial);
}

void NetPlay::start_system() { marking_ = after_start_; }

void NetPlay::restart(StartId start) {
  const ProcessId process = starts_[start].process;
  for (std::uint32_t place = 0; place < marking_.size(); ++place)
    if (net_.process_of({place}) == process) marking_[place] = after_start_[place];
  for (std::uint32_t channel = 0; channel < versions_.size(); ++channel)
    if (!net_[ChannelId{channel}].networked && net_[ChannelId{channel}].sending == process)
      versions_[channel] = {};
}

// ----------------------------------------------------------------------------------------------- segments

bool NetPlay::is_of(net::PlaceId place, StartId start) const {
  return !net_.is_hidden(place) && (!start.valid() || net_.process_of(place) == starts_[start].process);
}

/// Do both sides of the channel run in the process of the start?
bool NetPlay::is_within(ChannelId channel, StartId start) const {
  return !net_[channel].networked && (!start.valid() || net_[channel].sending == starts_[start].process);
}

std::optional<Problem> NetPlay::read_marking(std::string_view text, net::Marking& marking) {
  if (places_.empty())
    for (std::uint32_t index = 0; index < marking_.size(); ++index)
      places_.emplace(net_.net().places()[index].name, index);
  marking.assign(marking_.size(), 0);
  while (!text.empty()) {
    const std::string_view name = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), name.size() + 1));
    const auto found = places_.find(name);
    if (found == places_.end())
      return Problem{fmt::format("the marking names '{}', which is no place of the net", name)};
    marking[found->second] = 1;
  }
  return std::nullopt;
}

std::optional<Problem> NetPlay::compare(std::string_view marking, StartId start) {
  net::Marking other;
  if (std::optional<Problem> wrong = read_marking(marking, other)) return wrong;
  for (std::uint32_t place = 0; place < marking_.size(); ++place)
    if (is_of({place}, start) && marking_[place] != other[place])
      return Problem{
          fmt::format("a segment begins with another marking than the one before it ends with: '{}' holds {} "
                      "tokens there",
                      net_.net().places()[place].name, other[place])};
  return std::nullopt;
}

std::optional<Problem> NetPlay::start_from(std::string_view marking, StartId start) {
  net::Marking other;
  if (std::optional<Problem> wrong = read_marking(marking, other)) return wrong;
  for (std::uint32_t place = 0; place < marking_.size(); ++place)
    if (is_of({place}, start)) marking_[place] = other[place];
  for (std::uint32_t channel = 0; channel < links_.size(); ++channel)
    if (net_[ChannelId{channel}].networked)
      forget({channel}, start);
    else if (is_within({channel}, start))
      versions_[channel] = {.last = 0, .is = Version::unknown};
  return std::nullopt;
}

/// Forgets what is known of a channel between processes, as far as it is that of the start.
void NetPlay::forget(ChannelId channel, StartId start) {
  Link& link = links_[channel.value];
  const auto is_concerned = [&](ProcessId process) {
    return process.valid() && (!start.valid() || process == starts_[start].process);
  };
  const bool sends = is_concerned(net_[channel].sending), receives = is_concerned(net_[channel].receiving);
  if (!sends && !receives) return;
  link.markings = reachable(channel);
  link.tracked = link.tracked && link.fixed_peers;
  const auto make_unknown = [&](auto& side) {
    side.known = false;
    if (!link.fixed_peers) side.peer = not_given;
  };
  if (sends) std::ranges::for_each(link.sending, make_unknown);
  if (receives) std::ranges::for_each(link.receiving, make_unknown);
}

void NetPlay::guess_version(ChannelId channel, std::uint32_t version) {
  versions_[channel.value] = {.last = version == 1 ? UINT32_MAX : version - 1, .is = Version::guessed};
}

void NetPlay::confirm_versions(StartId start) {
  for (std::uint32_t channel = 0; channel < versions_.size(); ++channel)
    if (Version& version = versions_[channel]; is_within({channel}, start) && version.is == Version::guessed)
      version.is = Version::known;
}

// -------------------------------------------------------------------------------------------------- sides

NetPlay::Sending& NetPlay::sending(ChannelId channel, StartId start) {
  return links_[channel.value].sending[ordinals_[start]];
}
const NetPlay::Sending& NetPlay::sending(ChannelId channel, StartId start) const {
  return links_[channel.value].sending[ordinals_[start]];
}
NetPlay::Receiving& NetPlay::receiving(ChannelId channel, StartId start) {
  return links_[channel.value].receiving[ordinals_[start]];
}
const NetPlay::Receiving& NetPlay::receiving(ChannelId channel, StartId start) const {
  return links_[channel.value].receiving[ordinals_[start]];
}

// ------------------------------------------------------------------------------------------------- firing

std::optional<Problem> NetPlay::fire(const Firing& firing) {
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
  if (net_[id].effect != ChannelEffect::none) {
    stop_tracking(firing);
    if (!move_markings(firing))
      return Problem{fmt::format("'{}' fired, but no marking of '{}' allows it", net_.net()[id].name,
                                 net_.net().parts()[net_[id].channel])};
    count(firing);
  } else if (net_[id].channel.valid()) {
    Version& version = versions_[net_[id].channel.value];
    version.last = firing.version;
    if (version.is == Version::unknown) version.is = Version::guessed;
  }
  ++firings_;
  return std::nullopt;
}

/// A firing that needs what is not recorded: the markings after that are not known.
void NetPlay::stop_tracking(const Firing& firing) {
  const ChannelId channel = net_[firing.transition].channel;
  const DeployedNet::Channel& ends = net_[channel];
  const bool sends = starts_[firing.start].process == ends.sending;
  const StartId peer = sends ? sending(channel, firing.start).peer : receiving(channel, firing.start).peer;
  if (is_given(peer) && assumed_[peer]) links_[channel.value].tracked = false;
}

/// nullptr: the sender is not given.
NetPlay::Read* NetPlay::read_by(const Firing& firing) {
  const ChannelId channel = net_[firing.transition].channel;
  const StartId sender = receiving(channel, firing.start).peer;
  if (!is_given(sender)) return nullptr;
  std::vector<Read>& reads = sending(channel, sender).reads;
  if (reads.empty() || reads.back().start != firing.start) reads.push_back({.start = firing.start});
  return &reads.back();
}

void NetPlay::count(const Firing& firing) {
  const ChannelId channel = net_[firing.transition].channel;
  switch (net_[firing.transition].effect) {
    case ChannelEffect::writes:
      sending(channel, firing.start).written = firing.version;
      sending(channel, firing.start).known = true;
      break;
    case ChannelEffect::begins_read:
      receiving(channel, firing.start).last = firing.version;
      receiving(channel, firing.start).known = true;
      if (Read* read = read_by(firing); read != nullptr && read->first == 0) read->first = firing.version;
      break;
    case ChannelEffect::ends_read:
      if (Read* read = read_by(firing); read != nullptr) read->ended = firing.version;
      break;
    case ChannelEffect::is_acknowledged:
      sending(channel, firing.start).acknowledged = firing.version;
      break;
    case ChannelEffect::none:
    case ChannelEffect::begins_write:
    case ChannelEffect::gives_up:
    case ChannelEffect::skips:
      break;
  }
}

bool NetPlay::move_markings(const Firing& firing) {
  const DeployedNet::Transition& transition = net_[firing.transition];
  Link& link = links_[transition.channel.value];
  if (!link.tracked) return true;
  link.markings = with_medium(transition.channel, moved(link.markings, transition.moves));
  return link.markings != 0;
}

/// The markings after one of the moves.
std::uint64_t NetPlay::moved(std::uint64_t markings, std::span<const Move> moves) {
  std::uint64_t after = 0;
  for (; markings != 0; markings &= markings - 1) {
    const auto marking = static_cast<std::uint32_t>(std::countr_zero(markings));
    for (const Move& move : moves)
      if ((marking & move.takes) == move.takes)
        after |= std::uint64_t{1} << ((marking & ~move.takes) | move.gives);
  }
  return after;
}

/// Whatever the medium may do meanwhile, it may have done.
std::uint64_t NetPlay::with_medium(ChannelId channel, std::uint64_t markings) const {
  for (std::uint64_t before = 0; before != markings;) {
    before = markings;
    markings |= moved(markings, net_[channel].medium);
  }
  return markings;
}

/// All markings that the shared places of a channel can have.
std::uint64_t NetPlay::reachable(ChannelId channel) const {
  std::uint64_t all = links_[channel.value].initial;
  for (std::uint64_t before = 0; before != all;) {
    before = all;
    all = with_medium(channel, all | moved(all, net_[channel].sides));
  }
  return all;
}

// -------------------------------------------------------------------------------------------------- peers

NetPlay::StartId NetPlay::find_start(ProcessId process, std::uint64_t incarnation) const {
  for (const StartId start : of_process_[process])
    if (starts_[start].incarnation == incarnation) return start;
  return not_given;
}

/// false: it is an earlier one.
bool NetPlay::turn(Sending& side, StartId peer, std::uint64_t incarnation) const {
  if (incarnation <= side.peer_incarnation) return false;
  side.peer = peer;
  side.peer_incarnation = incarnation;
  side.acknowledged = 0;
  return true;
}

bool NetPlay::turn(ChannelId channel, StartId start, StartId peer, std::uint64_t incarnation) {
  std::vector<Receiving>& all = links_[channel.value].receiving;
  Receiving& side = receiving(channel, start);
  const bool goes_back =
      incarnation <= side.peer_incarnation ||
      std::any_of(all.begin(), all.begin() + ordinals_[start],
                  [&](const Receiving& before) { return before.peer_incarnation > incarnation; });
  if (!goes_back) side = {.last = 0, .peer = peer, .peer_incarnation = incarnation};
  return !goes_back;
}

std::optional<Problem> NetPlay::hear(ChannelId channel, StartId start, std::uint64_t incarnation) {
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
  if (peer == not_given) {
    links_[channel.value].tracked = false;
    unknown_peer_ = fmt::format("incarnation {} at the other end of '{}'", incarnation, name);
  }
  return std::nullopt;
}

}  // namespace tessera::replay
