#pragma once

#include <cstdint>
#include <string_view>

namespace tessera::mcap {

/// The CRC-32 of zlib and PNG. before: that of the bytes in front of these.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

}  // namespace tessera::mcap
