#include "tessera/value_encoding.hpp"

#include <algorithm>
#include <bit>

namespace tessera {
namespace {

constexpr std::uint64_t odd = 0x9e3779b97f4a7c15;  // derived from the golden ratio

[[nodiscard]] std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  const std::uint64_t product = (hash ^ word) * odd;
  return std::rotl(product, 29) ^ product;
}

/// Uses four lanes, because a processor can start a multiplication before the previous one has finished.
[[nodiscard]] std::uint64_t hash_of(const std::byte* bytes, std::size_t count, std::uint64_t seed) {
  std::array<std::uint64_t, 4> lanes{seed ^ count, seed + odd, ~seed, seed ^ odd};
  std::array<std::uint64_t, 4> words{};
  while (count > 0) {
    words = {};
    const std::size_t piece = std::min(count, sizeof words);
    std::memcpy(words.data(), bytes, piece);
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) lanes[lane] = mixed(lanes[lane], words[lane]);
    bytes += piece;
    count -= piece;
  }
  return mixed(mixed(mixed(lanes[0], lanes[1]), lanes[2]), lanes[3]);
}

}  // namespace

/// Bytes beyond the limit are hashed block by block, together with those that were kept before. Not inline:
/// with known limit and size, the compiler warns about a copy that is never made.
void ValueSink::put(const void* bytes, std::size_t count) {
  total_ += count;
  if (count > limit_ - filled_) return spill(bytes, count);
  std::memcpy(bytes_.get() + filled_, bytes, count);
  filled_ += count;
}

void ValueSink::spill(const void* bytes, std::size_t count) {
  const auto* next = static_cast<const std::byte*>(bytes);
  if (filled_ > 0) hash_ = hash_of(bytes_.get(), filled_, hash_);
  filled_ = 0;
  if (count > limit_) {
    hash_ = hash_of(next, count, hash_);
    return;
  }
  std::memcpy(bytes_.get(), next, count);
  filled_ = count;
}

std::uint64_t ValueSink::hash() const { return hash_of(bytes_.get(), filled_, hash_); }

}  // namespace tessera
