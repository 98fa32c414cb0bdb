#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tessera::drawing {

/// Text in one line, with superscripts and subscripts.
struct Label {
  enum class Level : std::uint8_t { base, raised, lowered };
  struct Run {
    std::string text;
    Level level = Level::base;
    bool italic = false;
    bool operator==(const Run&) const = default;
  };
  std::vector<Run> runs;

  Label() = default;
  explicit Label(std::string text);
  Label& add(std::string text, Level level = Level::base, bool italic = false);
  Label& add(const Label& other);

  [[nodiscard]] bool empty() const { return runs.empty(); }
  [[nodiscard]] std::string plain() const;  ///< without levels
  bool operator==(const Label&) const = default;
};

/// The approximate width of the text in a sans-serif font of that size, enough for the common fonts.
[[nodiscard]] double width_of(std::string_view text, double font_size);
[[nodiscard]] double width_of(const Label& label, double font_size);
inline constexpr double script_scale = 0.72;  ///< size of raised and lowered text

/// Wraps a long plain text into lines of about `width` characters, at most `lines`. The
/// rest is cut with an ellipsis.
[[nodiscard]] std::vector<std::string> wrapped(const std::string& text, std::size_t width, std::size_t lines);

}  // namespace tessera::drawing
