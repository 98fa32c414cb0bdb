#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::statistics {

/// Seeds that follow one another: begin, begin + 1, ..., end - 1.
struct Seeds {
  std::uint64_t begin = 0, end = 0;
  [[nodiscard]] std::uint64_t count() const { return end - begin; }
  [[nodiscard]] bool empty() const { return begin == end; }
  bool operator==(const Seeds&) const = default;
};

/// "seed 7", "seeds 7 to 9".
[[nodiscard]] std::string text_of(const Seeds& seeds);

/// One of several equal parts: 3 of 20.
struct Part {
  std::uint64_t number = 1, of = 1;
  bool operator==(const Part&) const = default;
};
/// Reads "3/20". nullopt: another form, or there is no such part.
[[nodiscard]] std::optional<Part> parse_part(std::string_view text);

/// The seeds of one part. The parts of one whole do not overlap, and together they are the whole; the counts
/// of any two differ by at most 1.
[[nodiscard]] Seeds seeds_of(const Part& part, const Seeds& whole);

/// Sorted, with gaps in between. Ranges that touch become one.
[[nodiscard]] std::vector<Seeds> joined(std::vector<Seeds> ranges);
/// The seeds that are in two of the ranges, the lowest first; nullopt: there are none.
[[nodiscard]] std::optional<Seeds> overlap_of(std::vector<Seeds> ranges);
/// The seeds of the whole that are in no range. ranges: as `joined` returns them.
[[nodiscard]] std::vector<Seeds> missing_in(const std::vector<Seeds>& ranges, const Seeds& whole);

}  // namespace tessera::statistics
