#include "links/network_end.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tessera {
namespace {

[[nodiscard]] std::uint16_t bit_of(std::span<const FusedPlace> places, PlaceRole role) {
  for (std::size_t place = 0; place < places.size(); ++place)
    if (places[place].role == role) return static_cast<std::uint16_t>(1U << place);
  return 0;
}

/// A blocking sender waits until the receiver's slot is empty.
[[nodiscard]] bool blocks(const System& whole, const Channel& channel) {
  const auto empty = std::ranges::find(channel.places, PlaceRole::empty, &FusedPlace::role);
  if (!channel.from.is_used() || empty == channel.places.end()) return false;
  const auto awaited = static_cast<std::uint16_t>(empty - channel.places.begin());
  for (const Transition& transition : whole.instances[channel.from.instance].net->transitions)
    for (const ArcEnd end : transition.inputs)
      if (end.port() == channel.from.port && end.place() == awaited) return true;
  return false;
}

/// Two processes without a named host count as processes of one host, for a first try.
[[nodiscard]] bool on_one_host(const System& whole, const Channel& channel) {
  return whole.processes[whole.process_of[channel.from.instance]].host ==
         whole.processes[whole.process_of[channel.to.instance]].host;
}

}  // namespace

LinkedChannel linked_channel(const System& whole, std::uint32_t number, bool is_sender) {
  const Channel& channel = whole.channels[number];
  const auto bit = [&](PlaceRole role) { return bit_of(channel.places, role); };
  LinkedChannel made;
  made.number = number;
  made.name = channel.name;
  made.sender = whole.process_of[channel.from.instance];
  made.receiver = whole.process_of[channel.to.instance];
  made.same_host = on_one_host(whole, channel);
  made.idle = bit(PlaceRole::idle);
  made.sent = bit(PlaceRole::sent);
  made.more = bit(PlaceRole::more);
  made.empty = bit(PlaceRole::empty);
  made.full = bit(PlaceRole::full);
  made.exchanged = made.idle == 0;
  made.sender_blocks = !made.exchanged && blocks(whole, channel);
  made.own_memory = bit(is_sender ? PlaceRole::sent_memory : PlaceRole::received_memory);
  return made;
}

void NetworkEnd::record_peer(network::Incarnation peer, Time now, RecordingLane* lane) {
  if (!peer.known() || peer == recorded_) return;
  recorded_ = peer;
  if (lane == nullptr) return;
  std::array<char, 512> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "{}\n{}", channel_.name, peer.value);
  lane->text(Event::Kind::peer, now, 0, {text.data(), std::min(end.size, text.size())});
}

}  // namespace tessera
