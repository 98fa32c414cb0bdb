#include "system/repeated_lines.hpp"

#include <algorithm>

#include "tessera/repetition.hpp"

namespace tessera {
namespace {

constexpr std::uint64_t shown_at_first = 3;

/// FNV-1a without numbers. Digits of names stay, because robot[1] is not robot[2], and joint_1 not joint_2.
std::uint64_t mixed(std::uint64_t hash, std::string_view text) {
  bool in_name = false;
  for (const char c : text) {
    const bool is_digit = c >= '0' && c <= '9';
    if (!is_digit) in_name = c == '[' || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!is_digit || in_name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return (hash ^ 0xff) * 0x100000001b3ULL;
}

template <std::size_t Size>
std::size_t copied(std::array<char, Size>& to, std::string_view from) {
  std::size_t size = std::min(Size, from.size());
  // A character of several bytes stays whole.
  while (size < from.size() && size > 0 && (static_cast<unsigned char>(from[size]) & 0xc0U) == 0x80U) --size;
  std::copy_n(from.data(), size, to.data());
  return size;
}

}  // namespace

RepeatedLines::Kind* RepeatedLines::find(std::uint64_t key, std::string_view path, std::string_view text) {
  for (std::size_t step = 0; step < kinds_.size(); ++step) {
    Kind& one = kinds_[(key + step) % kinds_.size()];
    std::uint64_t there = 0;
    if (one.key.compare_exchange_strong(there, key)) {
      one.path_size = copied(one.path, path);
      one.text_size = copied(one.text, text);
      one.ready = true;
      return &one;
    }
    if (there == key) return &one;
  }
  return nullptr;
}

RepeatedLines::Turn RepeatedLines::next(int level, std::string_view path, std::string_view text) {
  const auto seed = 0xcbf29ce484222325ULL + static_cast<std::uint64_t>(level);
  // The path keeps its digits: robot[1] is not robot[2].
  std::uint64_t key = seed;
  for (const char c : path) key = (key ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  key = mixed(key, text) | 1U;
  Kind* const kind = find(key, path, text);
  if (kind == nullptr) return {};
  const std::uint64_t count = ++kind->count;
  const bool printed = count <= shown_at_first || is_told(count);
  if (printed) kind->printed = count;
  return {printed, count};
}

}  // namespace tessera
