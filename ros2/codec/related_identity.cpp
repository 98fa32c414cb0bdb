#include "ros2/codec/related_identity.hpp"

#include <cstring>

namespace tessera::ros2 {
namespace {

constexpr std::uint16_t of_fast_dds = 0x800f, of_standard = 0x0083;
constexpr std::uint16_t end_of_list = 0x0001;
/// The two bits above tell vendors' parameters and those that must be understood.
constexpr std::uint16_t bits_of_kind = 0x3fff;
constexpr std::size_t size_of_identity = sizeof(Guid) + sizeof(std::int32_t) + sizeof(std::uint32_t);

template <class Number>
Number number_at(std::span<const std::byte> bytes, std::size_t at) {
  Number number{};
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

}  // namespace

std::optional<RelatedIdentity> related_identity_in(std::span<const std::byte> inline_qos) {
  constexpr std::size_t header = 2 * sizeof(std::uint16_t);
  while (inline_qos.size() >= header) {
    const auto name = number_at<std::uint16_t>(inline_qos, 0);
    const auto size = number_at<std::uint16_t>(inline_qos, sizeof name);
    if ((name & bits_of_kind) == end_of_list) return std::nullopt;
    inline_qos = inline_qos.subspan(header);
    if (size > inline_qos.size()) return std::nullopt;
    if ((name == of_fast_dds || name == of_standard) && size >= size_of_identity) {
      RelatedIdentity found;
      std::memcpy(found.endpoint.data(), inline_qos.data(), found.endpoint.size());
      const auto high = number_at<std::int32_t>(inline_qos, sizeof(Guid));
      const auto low = number_at<std::uint32_t>(inline_qos, sizeof(Guid) + sizeof high);
      constexpr std::int64_t of_high = std::int64_t{1} << 32U;
      found.sequence = high * of_high + low;
      return found;
    }
    inline_qos = inline_qos.subspan(size);
  }
  return std::nullopt;
}

}  // namespace tessera::ros2
