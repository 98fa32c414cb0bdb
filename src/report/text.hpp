#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

namespace tessera::report {

/// Appends formatted text.
template <class... Args>
void put(std::string& to, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(to), format, std::forward<Args>(args)...);
}

/// Escapes text for an element or an attribute. Control characters, which HTML forbids, marks that change
/// the direction of writing, and bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

/// The text without what `escaped` replaces, for pictures.
[[nodiscard]] std::string drawable(std::string_view text);

/// Cuts the text to that many bytes and lines of whole characters, with "…" for the rest.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t most_bytes, std::size_t most_lines);

/// 1234567 -> "1 234 567" with thin spaces.
[[nodiscard]] std::string grouped(std::uint64_t number);

/// For `src` and `href`.
[[nodiscard]] std::string data_uri(std::string_view mime, std::string_view bytes);

}  // namespace tessera::report
