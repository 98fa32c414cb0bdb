#include "links/links.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace tessera {

Links::Links(const Clock& clock, std::uint32_t channels, Complain complain)
    : clock_(clock),
      complain_(std::move(complain)),
      sent_(channels),
      received_(channels),
      sender_of_(channels),
      receiver_of_(channels) {}

Links::~Links() = default;

SendingEnd& Links::add_sender(const LinkedChannel& channel, SharedChannel& word,
                              const ValueEncoding& encoding, network::Incarnation incarnation) {
  senders_.push_back(std::make_unique<SendingEnd>(channel, word, encoding, incarnation, *this));
  add_gauges(channel.receiver, channel.number, Side::send);
  return *(sender_of_[channel.number] = senders_.back().get());
}

ReceivingEnd& Links::add_receiver(const LinkedChannel& channel, SharedChannel& word,
                                  const ValueEncoding& encoding, std::size_t value_bytes,
                                  const ValueType* type, network::Incarnation incarnation) {
  receivers_.push_back(
      std::make_unique<ReceivingEnd>(channel, word, encoding, value_bytes, type, incarnation, *this));
  add_gauges(channel.sender, channel.number, Side::receive);
  return *(receiver_of_[channel.number] = receivers_.back().get());
}

void Links::kill(network::ProcessNumber process) {
  const auto bury = [&](auto& ends, auto& of_channel) {
    for (auto& end : ends)
      if (end->own() == process) {
        of_channel[end->channel().number] = nullptr;
        dead_.push_back(std::move(end));
      }
    std::erase(ends, nullptr);
  };
  bury(senders_, sender_of_);
  bury(receivers_, receiver_of_);
}

void Links::add_gauges(network::ProcessNumber peer, std::uint32_t channel, Side side) {
  auto at = std::ranges::lower_bound(gauges_, peer, {}, [](const auto& one) { return one->peer; });
  if (at == gauges_.end() || (*at)->peer != peer) at = gauges_.insert(at, std::make_unique<LinkGauges>(peer));
  (side == Side::send ? sent_ : received_)[channel].link = at->get();
}

bool Links::Newest::again(const network::Data& data) {
  const auto age = [](const auto& one) { return std::tuple(one.from, one.number, one.recall); };
  if (age(data) <= age(*this)) return true;
  from = data.from;
  number = data.number;
  recall = data.recall;
  return false;
}

std::vector<network::ChannelSetup> Links::carried() const {
  std::vector<network::ChannelSetup> all;
  const auto add = [&](const auto& end) {
    const LinkedChannel& channel = end->channel();
    if (std::ranges::find(all, channel.number, &network::ChannelSetup::number) != all.end()) return;
    all.push_back({.number = channel.number,
                   .name = channel.name,
                   .sender = channel.sender,
                   .receiver = channel.receiver,
                   .longest_value_bytes = static_cast<std::uint32_t>(end->longest())});
  };
  std::ranges::for_each(senders_, add);
  std::ranges::for_each(receivers_, add);
  return all;
}

void Links::serve(Time until) {
  const Duration longest = std::max(std::min(until, next()) - clock_.now(), Duration::zero());
  carrier_->receive(*this, longest);
  const Time now = clock_.now();
  for (const auto& end : senders_)
    if (end->has_news() || end->next() <= now) end->serve(now, *this);
  for (const auto& end : receivers_)
    if (end->has_news() || end->next() <= now) end->serve(now, *this);
}

bool Links::has_work(Time now) const {
  const auto has = [&](const auto& end) { return end->has_news() || end->next() <= now; };
  return std::ranges::any_of(senders_, has) || std::ranges::any_of(receivers_, has);
}

Time Links::next() const {
  Time next = Time::max();
  for (const auto& end : senders_) next = std::min(next, end->next());
  for (const auto& end : receivers_) next = std::min(next, end->next());
  return next;
}

bool Links::pending() const {
  return std::ranges::any_of(senders_, [](const auto& end) { return end->pending() || end->has_news(); }) ||
         std::ranges::any_of(receivers_, [](const auto& end) { return end->has_news(); });
}

void Links::wake(std::uint32_t /*channel*/) { carrier_->wake(); }

void Links::joined(network::ProcessNumber one, network::ProcessNumber other, bool are) {
  const auto tell = [&](auto& end) {
    const std::pair pair(end->own(), end->peer());
    if (pair == std::pair(one, other) || pair == std::pair(other, one)) end->set_disconnected(!are);
  };
  std::ranges::for_each(senders_, tell);
  std::ranges::for_each(receivers_, tell);
}

// -------------------------------------------------------------------------------------------- heard

void Links::heard(network::ChannelNumber channel, const network::Data& data, const network::Value& value) {
  if (channel >= receiver_of_.size() || receiver_of_[channel] == nullptr) return;
  ReceivingEnd& end = *receiver_of_[channel];
  Newest& newest = received_[channel];
  const Time now = clock_.now();
  newest.link->hear(now, newest.again(data));
  end.hear(data, value, stamp_of(end.channel(), value.stamp), now, *this);
}

void Links::heard(network::ChannelNumber channel, const network::State& state) {
  if (channel >= sender_of_.size() || sender_of_[channel] == nullptr) return;
  const Time now = clock_.now();
  sent_[channel].link->hear(now, /*again=*/false);
  sender_of_[channel]->hear(state, now, *this);
}

void Links::reachable(network::ProcessNumber process, bool is_there) {
  const auto tell = [&](auto& end) {
    if (end->peer() == process) end->set_disconnected(!is_there);
  };
  std::ranges::for_each(senders_, tell);
  std::ranges::for_each(receivers_, tell);
  for (const auto& link : gauges_)
    if (link->peer == process) link->set_reachable(is_there, clock_.now());
}

void Links::alive(network::ProcessNumber process, const network::SignsOfLife& signs) {
  for (const auto& link : gauges_)
    if (link->peer == process) link->set_signs(signs, clock_.now());
}

void Links::complaint(std::string_view text) { complain_(text, /*fatal=*/false); }

// -------------------------------------------------------------------------------------------- sends

void Links::send(const LinkedChannel& channel, const network::Data& data, const network::Value& value) {
  network::Value stamped = value;
  stamped.stamp = stamp_to_send(channel, value.stamp);
  sent_[channel.number].link->count_sent(sent_[channel.number].again(data));
  carrier_->send(channel.number, data, stamped);
}

void Links::send(const LinkedChannel& channel, const network::State& state) {
  received_[channel.number].link->count_sent(/*again=*/false);
  carrier_->send(channel.number, state);
}

void Links::complain(const LinkedChannel& channel, std::string_view text, bool fatal) {
  complain_(fmt::format("channel {}: {}", channel.name, text), fatal);
}

// Processes of one host read one clock, so stamps are sent as they are. Between hosts, the age of the value
// is sent instead: the receiver adds the time since its arrival, so only the time on the way is missing.

std::chrono::nanoseconds Links::stamp_to_send(const LinkedChannel& channel,
                                              std::chrono::nanoseconds stamp) const {
  return channel.same_host ? stamp + origin_.load(std::memory_order_relaxed)
                           : clock_.now().time_since_epoch() - stamp;
}

Time Links::stamp_of(const LinkedChannel& channel, std::chrono::nanoseconds sent) const {
  const Time now = clock_.now();
  if (!channel.same_host) return now - std::max(sent, Duration::zero());
  return std::min(Time(sent - origin_.load(std::memory_order_relaxed)), now);
}

}  // namespace tessera
