#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tessera::ros2 {

/// A GUID of DDS: 12 bytes of the participant, 4 of the endpoint.
using Guid = std::array<std::uint8_t, 16>;
/// The part of a GUID that all endpoints of a participant share.
inline constexpr std::size_t participant_bytes = 12;

/// The GUIDs of Fast DDS begin with the number of its vendor.
[[nodiscard]] inline bool is_fast(const Guid& guid) { return guid[0] == 0x01 && guid[1] == 0x0f; }
[[nodiscard]] inline bool same_participant(const Guid& one, const Guid& other) {
  return std::equal(one.begin(), one.begin() + participant_bytes, other.begin());
}

/// Identifies a request as rmw_fastrtps_cpp does: in the inline QoS of the datagram, beside the data. In a
/// request it names the client's reader of replies. In a reply it names that reader, or, if the request had
/// no such identity, the writer of the request; and the sequence number of the request's datagram.
struct RelatedIdentity {
  Guid endpoint{};
  std::int64_t sequence = 0;

  bool operator==(const RelatedIdentity&) const = default;
};

/// Finds it in the inline QoS of a little-endian datagram. It has the parameter 0x800f of Fast DDS, or 0x0083
/// of the standard. nullopt: there is none.
[[nodiscard]] std::optional<RelatedIdentity> related_identity_in(std::span<const std::byte> inline_qos);

}  // namespace tessera::ros2
