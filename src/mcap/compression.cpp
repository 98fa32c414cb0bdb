#include "mcap/compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace tessera::mcap {
namespace {

constexpr int zstd_level = 3;
constexpr std::size_t first_room = 64U << 10U;

/// Makes room for more of a result that has `size` bytes in the end. false: it is complete, and more comes.
bool grow(std::string& result, std::size_t used, std::uint64_t size) {
  if (used < result.size()) return true;
  if (result.size() >= size) return false;
  result.resize(std::min<std::uint64_t>(size, std::max(first_room, 2 * result.size())));
  return true;
}

std::optional<std::string> decompress_zstd(std::string_view bytes, std::uint64_t size) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (context == nullptr) return std::nullopt;
  std::string result;
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  std::size_t used = 0;
  for (std::size_t state = 1; in.pos < in.size || state != 0;) {
    if (!grow(result, used, size) && in.pos >= in.size) return std::nullopt;
    ZSTD_outBuffer out{result.data(), result.size(), used};
    const std::size_t consumed = in.pos;
    state = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(state) != 0U) return std::nullopt;
    if (in.pos == consumed && out.pos == used) return std::nullopt;  // cut off, or longer than it says
    used = out.pos;
  }
  if (used != size) return std::nullopt;
  return result;
}

std::optional<std::string> decompress_lz4(std::string_view bytes, std::uint64_t size) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0U) return std::nullopt;
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, LZ4F_freeDecompressionContext);
  std::string result;
  std::size_t used = 0;
  for (std::size_t state = 1; !bytes.empty() || state != 0;) {
    static_cast<void>(grow(result, used, size));
    std::size_t made_bytes = result.size() - used, read = bytes.size();
    state = LZ4F_decompress(context.get(), result.data() + used, &made_bytes, bytes.data(), &read, nullptr);
    if (LZ4F_isError(state) != 0U || (made_bytes == 0 && read == 0)) return std::nullopt;
    used += made_bytes;
    bytes.remove_prefix(read);
  }
  if (used != size) return std::nullopt;
  return result;
}

}  // namespace

std::optional<std::string> compress(std::string_view bytes, std::string_view compression) {
  if (compression.empty()) return std::string(bytes);
  const bool with_zstd = compression == zstd;
  std::string result(
      with_zstd ? ZSTD_compressBound(bytes.size()) : LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  const std::size_t size =
      with_zstd ? ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), zstd_level)
                : LZ4F_compressFrame(result.data(), result.size(), bytes.data(), bytes.size(), nullptr);
  if ((with_zstd ? ZSTD_isError(size) : LZ4F_isError(size)) != 0U) return std::nullopt;
  result.resize(size);
  return result;
}

std::optional<std::string> decompress(std::string_view bytes, std::string_view compression,
                                      std::uint64_t size) {
  if (size > largest_chunk) return std::nullopt;
  if (compression == zstd) return decompress_zstd(bytes, size);
  if (compression == lz4) return decompress_lz4(bytes, size);
  if (!compression.empty() || bytes.size() != size) return std::nullopt;
  return std::string(bytes);
}

}  // namespace tessera::mcap
