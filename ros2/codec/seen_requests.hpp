#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <map>

#include "ros2/codec/related_identity.hpp"

namespace tessera::ros2 {

/// The requests that came already, if each may come in two ways. The requests of a client have growing numbers.
///
/// Threads: one at a time.
class SeenRequests {
 public:
  /// Requests that are so much older than the newest of their client count as seen; clients keep fewer.
  static constexpr std::size_t window = 256;
  /// The limit for clients; more push out those that were seen the longest time ago.
  static constexpr std::size_t most_clients = 1024;

  /// Whether it comes for the first time. endpoint: the client.
  [[nodiscard]] bool is_new(const RelatedIdentity& request);

 private:
  struct Client {
    std::int64_t newest = 0;
    std::bitset<window> seen{};  ///< the newest, the one before it, ...
    std::uint64_t turn = 0;
  };
  void forget_oldest();

  std::map<Guid, Client> clients_;
  std::uint64_t turns_ = 0;
};

}  // namespace tessera::ros2
