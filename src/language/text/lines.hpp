#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::language {

/// A position as editors count it: lines and columns from 0, columns in UTF-16 code units.
struct Position {
  std::uint32_t line = 0;
  std::uint32_t character = 0;

  auto operator<=>(const Position&) const = default;
};

/// Ends before `end`.
struct Range {
  Position start, end;

  auto operator<=>(const Range&) const = default;
};

/// Bytes [begin, end) of a text.
struct Extent {
  std::size_t begin = 0;
  std::size_t end = 0;

  auto operator<=>(const Extent&) const = default;
  /// A cursor behind the last byte still belongs to it.
  [[nodiscard]] bool touches(std::size_t offset) const { return begin <= offset && offset <= end; }
  [[nodiscard]] bool empty() const { return begin >= end; }
};

/// Converts between bytes of a text and positions of an editor. A line ends with LF, CRLF or CR.
///
/// Every position has an offset: one beyond the end of its line means the end of that line.
class Lines {
 public:
  /// The text must outlive this object.
  explicit Lines(std::string_view text);

  [[nodiscard]] std::size_t offset(Position position) const;
  [[nodiscard]] Position position(std::size_t offset) const;
  [[nodiscard]] Range range(Extent extent) const { return {position(extent.begin), position(extent.end)}; }
  /// Bytes of line `number` (from 0) without its end; "" if there is none.
  [[nodiscard]] std::string_view line(std::size_t number) const;
  [[nodiscard]] std::size_t start_of(std::size_t line) const;
  [[nodiscard]] std::size_t count() const { return starts_.size(); }

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;
};

/// Replaces `range` of `text`, as an editor tells its changes.
void replace(std::string& text, Range range, std::string_view with);

}  // namespace tessera::language
