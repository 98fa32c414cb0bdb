#include "statistics/seeds.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

namespace tessera::statistics {
namespace {

std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

void sort(std::vector<Seeds>& ranges) {
  std::erase_if(ranges, [](const Seeds& range) { return range.empty(); });
  std::ranges::sort(ranges, {}, &Seeds::begin);
}

}  // namespace

std::string text_of(const Seeds& seeds) {
  if (seeds.count() == 1) return fmt::format("seed {}", seeds.begin);
  return fmt::format("seeds {} to {}", seeds.begin, seeds.end - 1);
}

std::optional<Part> parse_part(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto which = number(text.substr(0, slash)), of = number(text.substr(slash + 1));
  if (!which || !of || *which < 1 || *which > *of) return std::nullopt;
  return Part{*which, *of};
}

Seeds seeds_of(const Part& part, const Seeds& whole) {
  __extension__ using Wide = unsigned __int128;  // the product may have more than 64 bits
  const auto border = [&](std::uint64_t parts) {
    return whole.begin + static_cast<std::uint64_t>(Wide{whole.count()} * parts / part.of);
  };
  return {border(part.number - 1), border(part.number)};
}

std::vector<Seeds> joined(std::vector<Seeds> ranges) {
  sort(ranges);
  std::vector<Seeds> all;
  for (const Seeds& range : ranges)
    if (!all.empty() && range.begin <= all.back().end)
      all.back().end = std::max(all.back().end, range.end);
    else
      all.push_back(range);
  return all;
}

std::optional<Seeds> overlap_of(std::vector<Seeds> ranges) {
  sort(ranges);
  for (std::size_t at = 1; at < ranges.size(); ++at)
    if (ranges[at].begin < ranges[at - 1].end)
      return Seeds{ranges[at].begin, std::min(ranges[at].end, ranges[at - 1].end)};
  return std::nullopt;
}

std::vector<Seeds> missing_in(const std::vector<Seeds>& ranges, const Seeds& whole) {
  std::vector<Seeds> missing;
  std::uint64_t next = whole.begin;
  for (const Seeds& range : ranges) {
    if (range.begin > next) missing.push_back({next, std::min(range.begin, whole.end)});
    next = std::max(next, range.end);
  }
  if (next < whole.end) missing.push_back({next, whole.end});
  return missing;
}

}  // namespace tessera::statistics
