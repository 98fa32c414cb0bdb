#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "ros2/codec/related_identity.hpp"
#include "tessera/time.hpp"

namespace tessera::ros2 {

/// The parameters of the sender of replies of one service.
struct FastSetup {
  std::uint32_t domain = 0;
  std::string interface = "lo";  ///< a name or an address
  std::string peers{};           ///< "10.0.0.2, cart.local"; without peers, discovery uses multicast
  std::string request_topic, request_type, reply_topic, reply_type;  ///< as DDS names them
  std::string user_data{};  ///< of both endpoints, as rmw_cyclonedds_cpp has it
};

/// Sends the replies of a server to clients that run rmw_fastrtps_cpp. These expect the identity of the
/// request beside the data, where Cyclone DDS cannot write it; Fast DDS can. The requests come by Cyclone DDS.
///
/// Threads: one at a time.
class FastReplies {
 public:
  FastReplies() = default;
  virtual ~FastReplies() = default;
  FastReplies(const FastReplies&) = delete;
  FastReplies& operator=(const FastReplies&) = delete;

  /// The GUID of the writer; its first 12 bytes are those of the participant.
  [[nodiscard]] virtual Guid identity() const = 0;
  /// Whether it has found that client, which a reader of replies or a writer of requests identifies.
  [[nodiscard]] virtual bool is_heard_by(const Guid& client) const = 0;
  /// message: with encapsulation. request: the client, and the number of its request. false: DDS refused.
  [[nodiscard]] virtual bool write(std::span<const std::byte> message, const RelatedIdentity& request) = 0;
  /// Whether all clients have received everything within this time.
  [[nodiscard]] virtual bool await_receipt(Duration timeout) = 0;
};

/// The only function of the library, which is loaded when the first such client has sent a request.
/// nullptr and `error`: Fast DDS refused.
inline constexpr const char* fast_replies_function = "tessera_ros2_fast_replies_1";
using MakeFastReplies = std::unique_ptr<FastReplies>(const FastSetup& setup, std::string& error);

}  // namespace tessera::ros2
