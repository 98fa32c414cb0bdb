#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tessera::ros2 {

/// Identifies a request of a service: its client and its number. It stands before the data of a request and
/// of its reply, as in rmw_cyclonedds_cpp. (rmw_fastrtps_cpp sends a RelatedIdentity beside the data instead.)
struct RequestHeader {
  std::uint64_t client = 0;   ///< a number that no other client has
  std::int64_t sequence = 0;  ///< number of the request

  bool operator==(const RequestHeader&) const = default;
};

/// Removes the header from a message with encapsulation, so that the message alone is left. nullopt: there is
/// no header, and the message is unchanged.
[[nodiscard]] std::optional<RequestHeader> take_header(std::vector<std::byte>& message);
/// Puts a header before the data of a little-endian message.
void put_header(const RequestHeader& header, std::vector<std::byte>& message);

}  // namespace tessera::ros2
