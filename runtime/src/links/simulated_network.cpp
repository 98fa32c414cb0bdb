#include "links/simulated_network.hpp"

#include <algorithm>

namespace tessera {
namespace {

constexpr double two_to_64 = 18446744073709551616.0;
constexpr int overtaken_delays = 10;

}  // namespace

SimulatedNetwork::SimulatedNetwork(const NetworkConditions& conditions, std::vector<Cut> cuts,
                                   std::vector<Outage> outages, Duration liveliness, std::uint64_t seed,
                                   const Clock& clock, std::vector<Channel> channels, Joined joined)
    : conditions_(conditions),
      cuts_(std::move(cuts)),
      outages_(std::move(outages)),
      liveliness_(liveliness),
      random_(seed ^ 0x6c696e6b73U),  // independent of the random order of turns
      clock_(clock),
      channels_(std::move(channels)),
      joined_(std::move(joined)),
      last_(2 * channels_.size()) {
  std::set<std::pair<network::ProcessNumber, network::ProcessNumber>> pairs;
  for (const Channel& channel : channels_) pairs.insert(std::minmax(channel.sender, channel.receiver));
  for (const auto& [one, other] : pairs)
    if (one != other) news_.emplace(Time{}, News{one, other, true});
  for (const Cut& cut : cuts_) {
    if (cut.until - cut.from > liveliness_)
      news_.emplace(cut.from + liveliness_, News{cut.one, cut.other, false});
    news_.emplace(cut.until, News{cut.one, cut.other, true});
  }
  for (const Outage& outage : outages_) tell_of(outage, pairs);
}

/// A new start of a process appears as gone, and then reachable, as on a real network.
void SimulatedNetwork::tell_of(
    const Outage& outage, const std::set<std::pair<network::ProcessNumber, network::ProcessNumber>>& pairs) {
  const bool ends = outage.until != Time::max();
  const Time back = ends ? outage.until + conditions_.delay : Time::max();
  for (const auto& [one, other] : pairs) {
    if (one == other || (one != outage.process && other != outage.process)) continue;
    news_.emplace(std::min(outage.from + liveliness_, back), News{one, other, false});
    if (ends) news_.emplace(back, News{one, other, true});
  }
}

void SimulatedNetwork::send(network::ChannelNumber channel, const network::Data& data,
                            const network::Value& value) {
  send({.channel = channel,
        .data = data,
        .stamp = value.stamp,
        .valid = value.valid,
        .bytes = {value.bytes.begin(), value.bytes.end()}});
}

void SimulatedNetwork::send(network::ChannelNumber channel, const network::State& state) {
  send({.channel = channel, .is_state = true, .state = state});
}

void SimulatedNetwork::send(Message message) {
  const Channel& channel = channels_[message.channel];
  const std::size_t lane = 2 * std::size_t{message.channel} + static_cast<std::size_t>(message.is_state);
  // Always drawn, so that a cut affects no other message.
  const bool lost = happens(conditions_.loss), twice = happens(conditions_.duplicate);
  const Time first = arrival(lane), second = twice ? arrival(lane) : first;
  if (lost || is_cut(channel.sender, channel.receiver, clock_.now())) return;
  if (twice) on_the_way_.emplace(second, message);
  on_the_way_.emplace(first, std::move(message));
}

/// The arrival of the next message of a channel in one direction. Only a slow message is overtaken.
Time SimulatedNetwork::arrival(std::size_t lane) {
  const Time usual = clock_.now() + conditions_.delay + up_to(conditions_.jitter);
  if (happens(conditions_.reorder))
    return usual + up_to(overtaken_delays * (conditions_.delay + conditions_.jitter));
  return last_[lane] = std::max(last_[lane], usual);
}

void SimulatedNetwork::receive(Listener& listener, std::chrono::nanoseconds /*longest*/) {
  const Time now = clock_.now();
  for (; !news_.empty() && news_.begin()->first <= now; news_.erase(news_.begin())) {
    const News& news = news_.begin()->second;
    if (news.joined &&
        (is_dead(news.one, now) || is_dead(news.other, now) || is_cut(news.one, news.other, now)))
      continue;  // there will be news when the cut is over
    joined_(news.one, news.other, news.joined);
  }
  while (!on_the_way_.empty() && on_the_way_.begin()->first <= now) {
    const auto node = on_the_way_.extract(on_the_way_.begin());
    const Message& message = node.mapped();
    const Channel& channel = channels_[message.channel];
    if (is_cut(channel.sender, channel.receiver, node.key())) continue;
    if (is_dead(message.is_state ? channel.sender : channel.receiver, node.key())) continue;
    if (message.is_state)
      listener.heard(message.channel, message.state);
    else
      listener.heard(message.channel, message.data, {message.stamp, message.valid, message.bytes});
  }
}

Time SimulatedNetwork::next() const {
  const Time message = on_the_way_.empty() ? Time::max() : on_the_way_.begin()->first;
  return std::min(message, news_.empty() ? Time::max() : news_.begin()->first);
}

Time SimulatedNetwork::last_cut() const {
  Time last{};
  for (const Cut& cut : cuts_) last = std::max(last, cut.until);
  for (const Outage& outage : outages_)
    last = std::max(last, outage.until == Time::max() ? outage.from : outage.until);
  return last;
}

bool SimulatedNetwork::is_dead(network::ProcessNumber process, Time at) const {
  return std::ranges::any_of(outages_, [&](const Outage& outage) {
    return outage.process == process && at >= outage.from && at < outage.until;
  });
}

bool SimulatedNetwork::is_cut(network::ProcessNumber one, network::ProcessNumber other, Time at) const {
  return std::ranges::any_of(cuts_, [&](const Cut& cut) {
    const bool is_theirs = (cut.one == one && cut.other == other) || (cut.one == other && cut.other == one);
    return is_theirs && at >= cut.from && at < cut.until;
  });
}

/// std::uniform_real_distribution differs from library to library.
bool SimulatedNetwork::happens(double probability) {
  return static_cast<double>(random_()) / two_to_64 < probability;
}

Duration SimulatedNetwork::up_to(Duration most) {
  const std::uint64_t drawn = random_();
  return most <= Duration::zero()
             ? Duration::zero()
             : Duration(static_cast<Duration::rep>(drawn % (static_cast<std::uint64_t>(most.count()) + 1)));
}

}  // namespace tessera
