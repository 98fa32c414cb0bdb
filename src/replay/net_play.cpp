#include "replay/net_play.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace tessera::replay {

using net::Arc;
using net::TransitionId;

std::string seconds_text(std::int64_t time_ns) {
  return fmt::format("{:.6f} s", static_cast<double>(time_ns) * 1e-9);
}

NetPlay::NetPlay(const Recording& recording, const net::Net& net)
    : recording_(recording), net_(net), marking_(net::initial_marking(net)) {
  mismatch_ = header_mismatch(recording, net);
  if (mismatch_) return;
  match_transitions();
  find_makers();
}

/// Numbers of the recording to numbers of the net, and the channel that each transition touches.
void NetPlay::match_transitions() {
  std::unordered_map<std::string_view, std::uint32_t> by_name;
  for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
    by_name.emplace(net_.transitions()[index].name, index);
  std::uint32_t count = 0;
  for (const Recording::Transition& recorded : recording_.transitions) {
    transitions_.push_back({by_name.at(recorded.name)});
    channels_.push_back(net_.channel_of(transitions_.back()));
    if (channels_.back().valid()) count = std::max(count, channels_.back().value + 1);
  }
  versions_.resize(count);
}

void NetPlay::find_makers() {
  std::vector<bool> seen(marking_.size(), false);
  makers_.assign(marking_.size(), std::nullopt);
  for (std::uint32_t index = 0; index < transitions_.size(); ++index)
    for (const Arc& arc : net_.postset(transitions_[index])) {
      const std::uint32_t instance = recording_.transitions[index].instance;
      std::optional<std::uint32_t>& maker = makers_[arc.place.value];
      if (seen[arc.place.value] && maker != instance)
        maker.reset();
      else
        maker = instance;
      seen[arc.place.value] = true;
    }
}

NetPlay::Obstacle NetPlay::obstacle(const Event& firing) const {
  const net::ChannelId channel = channels_[firing.subject];
  if ((firing.version != 0) != channel.valid()) return {.kind = Obstacle::Kind::never};
  if (channel.valid() && knows_version(channel)) {
    const std::uint32_t due = versions_[channel.value].due();
    if (firing.version != due)
      return {.kind = is_before(firing.version, due) ? Obstacle::Kind::never : Obstacle::Kind::version,
              .due = due};
  }
  for (const Arc& arc : net_.preset(transitions_[firing.subject])) {
    if (net::suffices(marking_, arc)) continue;
    // All firings of the channel up to this one have been played, and so have those of its own subsystem.
    const bool own = net_[arc.place].fused()
                         ? channel.valid() && versions_[channel.value].is == Version::known
                         : makers_[arc.place.value] == firing.instance();
    return {.kind = own ? Obstacle::Kind::never : Obstacle::Kind::token, .place = arc.place};
  }
  return {};
}

std::string NetPlay::complaint(const Event& firing, const Obstacle& obstacle) const {
  const std::string lacks =
      obstacle.place.valid() ? fmt::format("'{}' holds no token", place_name(obstacle.place))
      : obstacle.due != 0
          ? fmt::format("it is version {} of its channel, of which {} is due", firing.version, obstacle.due)
          : "it is recorded with the wrong kind of version";
  return fmt::format("{}: '{}' fired, but {}", seconds_text(firing.time_ns),
                     recording_.transitions[firing.subject].name, lacks);
}

std::optional<Problem> NetPlay::fire(const Event& firing) {
  const TransitionId id = transitions_[firing.subject];
  if (const net::ChannelId channel = channels_[firing.subject]; channel.valid()) {
    versions_[channel.value].last = firing.version;
    if (!knows_version(channel)) versions_[channel.value].is = Version::guessed;
  }
  net::fire(net_, id, marking_);
  for (const Arc& arc : net_.postset(id))
    if (marking_[arc.place.value] > 1)
      return Problem{fmt::format("{}: '{}' puts a second token into '{}'", seconds_text(firing.time_ns),
                                 net_[id].name, net_[arc.place].name)};
  ++firings_;
  return std::nullopt;
}

std::optional<std::vector<std::uint32_t>> NetPlay::read_marking(const Recording::Entry& entry,
                                                                std::string& wrong) {
  if (places_.empty())
    for (std::uint32_t index = 0; index < net_.places().size(); ++index)
      places_.emplace(net_.places()[index].name, index);
  std::vector<std::uint32_t> marking(net_.places().size(), 0);
  for (std::string_view left = entry.text; !left.empty();) {
    const std::string_view name = left.substr(0, left.find('\n'));
    left.remove_prefix(std::min(left.size(), name.size() + 1));
    const auto found = places_.find(name);
    if (found == places_.end()) {
      wrong = fmt::format("{}: the marking names '{}', which is no place of the net",
                          seconds_text(entry.event.time_ns), name);
      return std::nullopt;
    }
    marking[found->second] = 1;
  }
  return marking;
}

void NetPlay::start_from(std::vector<std::uint32_t> marking) {
  marking_ = std::move(marking);
  versions_.assign(versions_.size(), {.last = 0, .is = Version::unknown});
}

net::PlaceId NetPlay::difference(const std::vector<std::uint32_t>& marking) const {
  const auto [ours, other] = std::ranges::mismatch(marking_, marking);
  if (ours == marking_.end()) return {};
  return {static_cast<std::uint32_t>(ours - marking_.begin())};
}

void NetPlay::guess_version(net::ChannelId channel, std::uint32_t version) {
  versions_[channel.value] = {.last = version == 1 ? UINT32_MAX : version - 1, .is = Version::guessed};
}

void NetPlay::confirm_versions() {
  for (Version& version : versions_)
    if (version.is == Version::guessed) version.is = Version::known;
}

}  // namespace tessera::replay
