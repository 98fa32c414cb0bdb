#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tessera::mcap {

/// A larger chunk is not read. The sizes in a file may be wrong, so they must not decide what memory is used.
inline constexpr std::uint64_t largest_chunk = 256U << 20U;

inline constexpr std::string_view zstd = "zstd", lz4 = "lz4", uncompressed;

/// compression: zstd, lz4 or uncompressed. nullopt: the library refused, for want of memory.
[[nodiscard]] std::optional<std::string> compress(std::string_view bytes, std::string_view compression);

/// size: as the file says, of the result. nullopt: an unknown compression, damaged bytes, another size, or one
/// above `largest_chunk`. Uses at most twice the memory of what the bytes really contain.
[[nodiscard]] std::optional<std::string> decompress(std::string_view bytes, std::string_view compression,
                                                    std::uint64_t size);

}  // namespace tessera::mcap
