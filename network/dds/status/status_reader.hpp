#pragma once

#include <memory>
#include <string>

#include "network/dds/endpoints.hpp"
#include "network/dds/location.hpp"
#include "network/dds/peer_search.hpp"
#include "network/status.hpp"

namespace tessera::dds {

/// Reads the status of the processes of a system over Cyclone DDS: a participant of their domain that writes nothing.
/// It counts as one of the processes that can be found on its host.
class DdsStatusReader final : public network::StatusReader {
 public:
  /// It waits for the name service. Errors: SetupError.
  explicit DdsStatusReader(const network::StatusReaderSetup& setup);
  void receive(Listener& listener, std::chrono::nanoseconds longest) override;

 private:
  /// The participant, and what it reads with.
  struct Reading {
    Reading(int number, const Location& location, const std::string& system);
    Domain domain;
    dds_entity_t reader = 0, waitset = 0;
  };
  void tell_of_unresolved(Listener& listener);
  void join_found(Listener& listener);
  void take(Listener& listener) const;

  std::string system_;
  int domain_;
  Location location_;
  PeerSearch search_;
  std::unique_ptr<Reading> reading_;
};

}  // namespace tessera::dds
