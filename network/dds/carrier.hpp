#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "network/carrier.hpp"
#include "network/dds/announcements.hpp"
#include "network/dds/deployment.hpp"
#include "network/dds/dropped.hpp"
#include "network/dds/endpoints.hpp"
#include "network/dds/location.hpp"
#include "network/dds/peer_search.hpp"
#include "network/dds/presence.hpp"
#include "network/dds/received.hpp"
#include "network/dds/signs_of_life.hpp"
#include "wire.h"

namespace tessera::dds {

/// Carries the messages of channels over Cyclone DDS (docs/use/fleets.md, "On the wire").
///
/// A process that shares a channel with this one is reachable while its signs of life arrive. They are sent
/// by receive(), so a process that does not call it is unreachable for the others. When an incarnation
/// replaces another, the process is reported as unreachable, then as reachable.
///
/// After its construction, it allocates nothing for a message. (The middleware does.)
class DdsCarrier final : public network::Carrier {
 public:
  /// address_of: resolves peers that are given by name; the constructor waits for it. A peer that has no
  /// address yet is looked up again later, and the process goes on without it meanwhile.
  /// Errors: SetupError.
  explicit DdsCarrier(const network::CarrierSetup& setup, const AddressOf& address_of = resolve,
                      std::chrono::milliseconds search_interval = PeerSearch::interval);

  void send(ChannelNumber channel, const network::Data& data, const network::Value& value) override;
  void send(ChannelNumber channel, const network::State& state) override;
  void receive(Listener& listener, std::chrono::nanoseconds longest) override;
  void wake() override;
  std::size_t watchers() override;
  void send_status(network::StatusPart part, std::string_view text) override;

 private:
  void take_all(Listener& listener);
  void tell_of_unresolved(Listener& listener);
  void join_found(Listener& listener);
  void take_announcements(Listener& listener);
  /// Takes the messages of a reader. Each is valid until the next one is taken.
  template <class Sample, class Hear>
  void take_from(dds_entity_t reader, const Hear& hear_one);
  void give_room(tessera_wire_Data& sample);
  /// false: it is dropped.
  template <class Sample>
  [[nodiscard]] bool is_good(const Sample& sample);
  void hear(const tessera_wire_Data& data, Listener& listener, Clock::time_point now);
  void hear(const tessera_wire_State& state, Listener& listener, Clock::time_point now);
  void hear(const tessera_wire_Alive& alive, Listener& listener, Clock::time_point now);
  void give_sign_of_life(Clock::time_point now);
  [[nodiscard]] Clock::time_point next_event() const;
  void count_unsent(dds_return_t result, const Channel& channel);

  Deployment deployment_;
  Presence presence_;
  Announcements announcements_;
  SignsOfLife signs_;
  Dropped dropped_{"dropped"}, unsent_{"could not send"};
  Location location_;
  PeerSearch search_;
  const int domain_;
  std::mutex replacing_;  ///< protects endpoints_ against wake()
  /// Protects endpoints_ against the thread that sends the status: wake() does not wait for that.
  std::mutex sending_status_;
  std::unique_ptr<Endpoints> endpoints_;
  Clock::time_point next_sign_of_life_ = Clock::time_point::min();
  std::vector<std::uint8_t> room_;  ///< buffer for the value that is read next
};

}  // namespace tessera::dds
