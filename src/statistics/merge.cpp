#include "statistics/merge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace tessera::statistics {
namespace {

using Setting = std::pair<std::string, std::string>;

std::string shown(const std::string& value) { return value.empty() ? "nothing" : "'" + value + "'"; }

/// The difference between two identities; nullopt: there is none.
std::optional<std::string> difference(const Identity& one, const Identity& other, bool other_builds) {
  const auto differ = [](const char* what, const std::string& a, const std::string& b) {
    return a == b ? std::nullopt : std::optional(fmt::format("the {} {} and {}", what, shown(a), shown(b)));
  };
  for (const std::optional<std::string>& text :
       {differ("systems", one.system, other.system), differ("nets", one.net, other.net),
        differ("specifications", one.specification, other.specification)})
    if (text) return text;
  std::set<std::string> names;
  for (const auto* settings : {&one.settings, &other.settings})
    for (const auto& setting : *settings) names.insert(setting.first);
  const auto value_in = [](const Identity& identity, const std::string& name) {
    const auto found = identity.settings.find(name);
    return found == identity.settings.end() ? std::string() : found->second;
  };
  for (const std::string& name : names)
    if (value_in(one, name) != value_in(other, name))
      return fmt::format("`{}`: {} and {}", name, shown(value_in(one, name)), shown(value_in(other, name)));
  if (other_builds || one.controller == other.controller) return std::nullopt;
  return fmt::format("the programs {} and {}; if only their builds differ, pass --other-builds",
                     shown(one.controller), shown(other.controller));
}

void add(std::vector<Outcome>& all, const Outcome& more) {
  const auto found = std::ranges::find_if(
      all, [&](const Outcome& one) { return one.kind == more.kind && one.name == more.name; });
  if (found == all.end()) {
    all.push_back(more);
    return;
  }
  const bool is_first = more.runs > 0 && (found->runs == 0 || more.first_seed < found->first_seed);
  found->runs += more.runs;
  found->failed += more.failed;
  if (is_first)
    std::tie(found->first_seed, found->at_s, found->text) = std::tie(more.first_seed, more.at_s, more.text);
}

void add(std::vector<Injected>& all, const Injected& more) {
  const auto found = std::ranges::find(all, more.fault, &Injected::fault);
  if (found == all.end()) {
    all.push_back(more);
    return;
  }
  found->runs += more.runs;
  found->missed += more.missed;
}

void add(std::vector<Distribution>& all, const Distribution& more) {
  const auto found = std::ranges::find_if(
      all, [&](const Distribution& one) { return one.name == more.name && one.unit == more.unit; });
  if (found == all.end())
    all.push_back(more);
  else
    found->samples.add(more.samples.parts());
}

void add(Results& sum, const Results& more) {
  sum.whole = {std::min(sum.whole.begin, more.whole.begin), std::max(sum.whole.end, more.whole.end)};
  sum.ran.insert(sum.ran.end(), more.ran.begin(), more.ran.end());
  sum.ran = joined(std::move(sum.ran));
  sum.tried += more.tried;
  sum.failed += more.failed;
  sum.simulated_s += more.simulated_s;
  sum.wall_s += more.wall_s;
  sum.firings += more.firings;
  sum.interrupted = sum.interrupted || more.interrupted;
  sum.not_repeated.insert(sum.not_repeated.end(), more.not_repeated.begin(), more.not_repeated.end());
  for (const Outcome& kind : more.kinds) add(sum.kinds, kind);
  for (const Outcome& outcome : more.outcomes) add(sum.outcomes, outcome);
  for (const Injected& one : more.injected) add(sum.injected, one);
  if (sum.ended_by_themselves && more.ended_by_themselves)
    *sum.ended_by_themselves += *more.ended_by_themselves;
  else
    sum.ended_by_themselves.reset();  // then it is not known of all runs
  sum.ended_with_failed_check += more.ended_with_failed_check;
  for (const Distribution& one : more.distributions) add(sum.distributions, one);
  if (more.failure && (!sum.failure || more.failure->seed < sum.failure->seed)) sum.failure = more.failure;
  for (const auto& [name, firings] : more.transitions) sum.transitions[name] += firings;
}

/// The file of the others in which a seed of these results was run, too.
std::optional<std::string> file_with_same_seed(const NamedResults& one,
                                               const std::vector<NamedResults>& others, std::size_t count,
                                               Seeds& both) {
  for (std::size_t index = 0; index < count; ++index) {
    std::vector<Seeds> ranges = others[index].results.ran;
    ranges.insert(ranges.end(), one.results.ran.begin(), one.results.ran.end());
    if (const std::optional<Seeds> overlap = overlap_of(std::move(ranges))) {
      both = *overlap;
      return others[index].file;
    }
  }
  return std::nullopt;
}

}  // namespace

Result<Results> merge(const std::vector<NamedResults>& all, bool other_builds) {
  Results sum = all.front().results;
  bool is_divided_alike = true, counts_firings = true;
  for (std::size_t index = 0; index < all.size(); ++index) {
    const auto& [file, results] = all[index];
    const Results& first = all.front().results;
    if (const auto what = difference(first.identity, results.identity, other_builds))
      return Problem{fmt::format("{} and {} are of different runs: {}", all.front().file, file, *what)};
    Seeds both;
    if (const auto other = file_with_same_seed(all[index], all, index, both))
      return Problem{
          fmt::format("{} and {} both have {}, which would be counted twice", *other, file, text_of(both))};
    is_divided_alike = is_divided_alike && results.whole == first.whole && results.parts == first.parts;
    counts_firings = counts_firings && (results.tried == 0 || !results.transitions.empty());
    if (index > 0) add(sum, results);
  }
  if (!is_divided_alike) sum.parts = 1;
  if (!counts_firings) sum.transitions.clear();  // the sum of some would look like that of all
  std::ranges::sort(sum.outcomes, {}, [](const Outcome& one) { return std::tie(one.kind, one.name); });
  return sum;
}

std::vector<std::string> missing_parts(const Results& results) {
  std::vector<std::string> lines;
  const std::vector<Seeds> missing = missing_in(results.ran, results.whole);
  if (results.parts <= 1 || results.parts > results.whole.count()) {
    for (const Seeds& seeds : missing) lines.push_back(text_of(seeds));
    return lines;
  }
  for (std::uint64_t number = 1; number <= results.parts; ++number) {
    const Seeds part = seeds_of({number, results.parts}, results.whole);
    std::string text;
    for (const Seeds& gap : missing) {
      const Seeds both{std::max(gap.begin, part.begin), std::min(gap.end, part.end)};
      if (both.begin < both.end) text += (text.empty() ? "" : ", ") + text_of(both);
    }
    if (!text.empty()) lines.push_back(fmt::format("part {}/{}: {}", number, results.parts, text));
  }
  return lines;
}

}  // namespace tessera::statistics
