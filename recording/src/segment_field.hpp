#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

/// The last field in the header of a segment: ,"segment":NUMBER}.
namespace tessera {

inline constexpr std::string_view segment_key = ",\"segment\":";

/// The part of the header that all segments of one run have in common.
[[nodiscard]] inline std::string_view without_segment(std::string_view header) {
  return header.substr(0, header.rfind(segment_key));
}

/// nullopt: it is not the header of a segment.
[[nodiscard]] inline std::optional<std::uint64_t> segment_in(std::string_view header) {
  const std::size_t at = header.rfind(segment_key);
  if (at == std::string_view::npos) return std::nullopt;
  std::uint64_t number = 0;
  const char* const begin = header.data() + at + segment_key.size();
  if (std::from_chars(begin, header.data() + header.size(), number).ec != std::errc{}) return std::nullopt;
  return number;
}

}  // namespace tessera
