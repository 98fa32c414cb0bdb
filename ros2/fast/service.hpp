#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ros2/codec/related_identity.hpp"
#include "tessera/time.hpp"

namespace tessera::ros2 {

/// The parameters of one side of a service.
struct FastSetup {
  std::uint32_t domain = 0;
  std::string interface = "lo";  ///< a name or an address
  std::string peers{};           ///< "10.0.0.2, cart.local"; without peers, discovery uses multicast
  std::string request_topic, request_type, reply_topic, reply_type;  ///< as DDS names them
  std::string user_data{};  ///< of both endpoints, as rmw_cyclonedds_cpp has it
  bool is_client = false;
};

/// One side of a service by Fast DDS, for another side that runs rmw_fastrtps_cpp. That expects the identity of a
/// request beside the data, where Cyclone DDS cannot write it. And it sends as soon as it has found us, at which time
/// Cyclone DDS may not have found it; Cyclone DDS then skips the message, and Fast DDS asks for it.
///
/// Threads: one at a time.
class FastService {
 public:
  FastService() = default;
  virtual ~FastService() = default;
  FastService(const FastService&) = delete;
  FastService& operator=(const FastService&) = delete;

  /// The GUID of the writer; its first 12 bytes are those of the participant.
  [[nodiscard]] virtual Guid identity() const = 0;
  struct Message {
    /// For a server: the client's reader of replies, and the number of the request. For a client: its own reader, and
    /// the number of its request.
    RelatedIdentity request;
    std::vector<std::byte> bytes{};  ///< with encapsulation
  };
  /// The messages that came since the last call, the oldest first. Those without an identity, and replies to other
  /// clients, are left out.
  [[nodiscard]] virtual std::vector<Message> take() = 0;
  /// Whether all readers have received everything within this time.
  [[nodiscard]] virtual bool await_receipt(Duration timeout) = 0;

  /// For a server: whether it has found that client, which a reader of replies or a writer of requests identifies.
  [[nodiscard]] virtual bool is_heard_by(const Guid& client) const = 0;
  /// For a server: whether a writer of requests of that participant exists.
  [[nodiscard]] virtual bool is_there(const Guid& client) const = 0;
  /// For a server: false: DDS refused. message: with encapsulation. request: the client, and the number of its request.
  [[nodiscard]] virtual bool reply(std::span<const std::byte> message, const RelatedIdentity& request) = 0;

  /// For a client: the servers that were found, and receive a request. Such a server waits until it has found our
  /// reader of replies. 0 if a request would also reach a reader that is not one of Fast DDS.
  [[nodiscard]] virtual std::size_t servers() const = 0;
  /// For a client: gives the number of the request. nullopt: DDS refused.
  [[nodiscard]] virtual std::optional<std::int64_t> request(std::span<const std::byte> message) = 0;
};

/// The only function of the library, which is loaded when the first such client or server was found.
/// nullptr and `error`: Fast DDS refused.
inline constexpr const char* fast_service_function = "tessera_ros2_fast_service_2";
using MakeFastService = std::unique_ptr<FastService>(const FastSetup& setup, std::string& error);

}  // namespace tessera::ros2
