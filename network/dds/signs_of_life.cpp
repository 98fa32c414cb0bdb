#include "network/dds/signs_of_life.hpp"

#include <algorithm>
#include <bit>

namespace tessera::dds {
namespace {

constexpr std::uint32_t window = 64;
/// Later times cannot be genuine, and sums of them would overflow.
constexpr std::int64_t latest_ns = std::int64_t{1} << 62;

}  // namespace

SignsOfLife::SignsOfLife(const Deployment& deployment)
    : process_(deployment.process), incarnation_(deployment.incarnation) {
  for (const ProcessNumber peer : deployment.peers) peers_.push_back({.process = peer});
}

tessera_wire_Alive SignsOfLife::next(Duration steady, Duration wall) {
  tessera_wire_Alive sign{};
  sign.process = process_;
  sign.incarnation = incarnation_;
  sign.number = ++number_;
  sign.sent_ns = steady.count();
  sign.wall_ns = wall.count();
  for (std::size_t tried = 0; tried < peers_.size(); ++tried) {
    const Peer& peer = peers_[turn_++ % peers_.size()];
    if (peer.incarnation == 0) continue;
    sign.echo_process = peer.process;
    sign.echo_incarnation = peer.incarnation;
    sign.echo_ns = peer.its_time.count();
    sign.held_ns = (steady - peer.came).count();
    break;
  }
  return sign;
}

std::optional<network::SignsOfLife> SignsOfLife::hear(const tessera_wire_Alive& sign, Duration steady,
                                                      Duration wall) {
  const auto found = std::ranges::lower_bound(peers_, sign.process, {}, &Peer::process);
  if (found == peers_.end() || found->process != sign.process) return std::nullopt;
  Peer& peer = *found;
  if (sign.incarnation < peer.incarnation) return std::nullopt;
  if (sign.incarnation > peer.incarnation)  // the process may run on another machine now
    peer = {.process = peer.process, .incarnation = sign.incarnation};
  take_number(peer, sign.number);
  if (sign.number == peer.newest) {
    peer.its_time = Duration(sign.sent_ns);
    peer.came = steady;
  }
  take_echo(peer, sign, steady, wall);
  const auto came = static_cast<std::uint32_t>(std::popcount(peer.seen));
  return network::SignsOfLife{peer.expected, peer.expected - std::min(came, peer.expected),
                              peer.clock.at(steady)};
}

void SignsOfLife::take_number(Peer& peer, std::uint64_t number) const {
  if (peer.expected == 0) {  // the first sign that arrives need not be the first that was sent
    peer.newest = number;
    peer.seen = peer.expected = 1;
  } else if (number > peer.newest) {
    const std::uint64_t further = number - peer.newest;
    peer.seen = further < window ? peer.seen << further | 1U : 1U;
    peer.expected = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(window, std::min<std::uint64_t>(window, further) + peer.expected));
    peer.newest = number;
  } else if (const std::uint64_t late = peer.newest - number; late < peer.expected) {
    peer.seen |= std::uint64_t{1} << late;
  }
}

void SignsOfLife::take_echo(Peer& peer, const tessera_wire_Alive& sign, Duration steady,
                            Duration wall) const {
  if (sign.echo_process != process_ || sign.echo_incarnation != incarnation_) return;
  const auto possible = [](std::int64_t time) { return time >= 0 && time < latest_ns; };
  if (!possible(sign.echo_ns) || !possible(sign.held_ns) || !possible(sign.wall_ns)) return;
  const Duration on_the_way = steady - Duration(sign.echo_ns) - Duration(sign.held_ns);
  if (on_the_way < Duration::zero()) return;
  peer.clock.add(Duration(sign.wall_ns) - wall, on_the_way, steady);
}

}  // namespace tessera::dds
