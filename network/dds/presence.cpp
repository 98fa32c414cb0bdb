#include "network/dds/presence.hpp"

#include <algorithm>

namespace tessera::dds {
namespace {

/// Some late messages of a process that has just restarted are no complaint; continued signs of life are.
constexpr int older_is_there = 5;

}  // namespace

Presence::Presence(const Deployment& deployment) : longest_silence_(deployment.liveliness) {
  for (const ProcessNumber peer : deployment.peers) peers_[peer].name = deployment.processes[peer];
}

void Presence::heard(ProcessNumber process, std::uint64_t incarnation, Clock::time_point now,
                     network::Carrier::Listener& listener) {
  const auto found = peers_.find(process);
  if (found == peers_.end()) return;
  Peer& peer = found->second;
  if (incarnation < peer.incarnation) return heard_older(peer, incarnation, listener);
  if (incarnation > peer.incarnation) {
    if (peer.is_there) listener.reachable(process, false);
    peer.is_there = false;
    peer.incarnation = incarnation;
    peer.heard_of_older = 0;
  }
  peer.heard = now;
  if (peer.is_there) return;
  peer.is_there = true;
  listener.reachable(process, true);
}

void Presence::heard_older(Peer& peer, std::uint64_t incarnation, network::Carrier::Listener& listener) {
  if (peer.older != incarnation) {
    peer.older = incarnation;
    peer.heard_of_older = 0;
  }
  if (peer.heard_of_older > older_is_there) return;
  if (++peer.heard_of_older == older_is_there)
    listener.complaint("process " + peer.name +
                       " speaks with an incarnation older than one that was there: it is ignored. It was "
                       "started a second time, or its clock was set back before it was restarted");
}

void Presence::left(ProcessNumber process, std::uint64_t incarnation, network::Carrier::Listener& listener) {
  const auto found = peers_.find(process);
  if (found == peers_.end() || !found->second.is_there || found->second.incarnation != incarnation) return;
  found->second.is_there = false;
  listener.reachable(process, false);
}

void Presence::look(Clock::time_point now, network::Carrier::Listener& listener) {
  for (auto& [process, peer] : peers_) {
    if (!peer.is_there || now - peer.heard < longest_silence_) continue;
    peer.is_there = false;
    listener.reachable(process, false);
  }
}

std::optional<Clock::time_point> Presence::next_look() const {
  std::optional<Clock::time_point> next;
  for (const auto& [process, peer] : peers_)
    if (peer.is_there)
      next = std::min(next.value_or(Clock::time_point::max()), peer.heard + longest_silence_);
  return next;
}

}  // namespace tessera::dds
