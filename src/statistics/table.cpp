#include "statistics/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "statistics/clopper_pearson.hpp"
#include "statistics/percentiles.hpp"

namespace tessera::statistics {
namespace {

/// In a fleet, the rows of its first members are shown; the JSON has all.
constexpr std::size_t most_rows_of_a_kind = 12, most_commands = 12, longest_text = 160, label_width = 32;

std::string interval_text(std::uint64_t events, std::uint64_t runs) {
  const Interval interval = clopper_pearson(events, runs);
  return fmt::format("{} to {}", percent(interval.low), percent(interval.high));
}

std::string cut(const std::string& text) {
  return text.size() <= longest_text ? text : text.substr(0, longest_text) + "...";
}

std::string row(const Outcome& outcome, const std::string& label, const Results& results) {
  const double share = static_cast<double>(outcome.runs) / static_cast<double>(results.tried);
  // The name of a check may be its whole formula.
  const bool fits = label.size() <= label_width;
  std::string text = fits ? "" : label + "\n";
  text += fmt::format("{:<{}} {:>9} {:>9}   {:<22} {:>10}", fits ? label : "", label_width, outcome.runs,
                      percent(share), interval_text(outcome.runs, results.tried),
                      outcome.runs == 0 ? "-" : std::to_string(outcome.first_seed));
  if (outcome.failed < outcome.runs)
    text +=
        fmt::format("   {}", outcome.failed == 0 ? "none of these runs failed"
                                                 : fmt::format("{} of these runs failed", outcome.failed));
  return text + "\n";
}

std::string first_of(const Outcome& outcome) {
  const std::string time = std::isnan(outcome.at_s) ? "" : fmt::format("{:.6f} s: ", outcome.at_s);
  return fmt::format("    {}{}\n", time, cut(outcome.text));
}

/// Kinds of failures that happened, or could have and never did.
bool has_rows(const Outcome& kind, const Results& results) {
  return kind.runs > 0 || std::ranges::any_of(results.outcomes, [&](const Outcome& outcome) {
           return outcome.kind == kind.kind && !outcome.name.empty();
         });
}

std::string rows_of(const Outcome& kind, const Results& results) {
  std::vector<const Outcome*> named, never;
  for (const Outcome& outcome : results.outcomes)
    if (outcome.kind == kind.kind) (outcome.runs > 0 ? named : never).push_back(&outcome);
  std::string text = row(kind, kind.kind, results);
  const bool has_names =
      !never.empty() || std::ranges::any_of(named, [](const Outcome* one) { return !one->name.empty(); });
  if (!has_names) return text + first_of(kind);
  std::ranges::stable_sort(named, std::greater{}, &Outcome::runs);
  for (std::size_t index = 0; index < std::min(named.size(), most_rows_of_a_kind); ++index) {
    const Outcome& one = *named[index];
    text += row(one, "  " + one.name, results);
    text += first_of(one);
  }
  if (named.size() > most_rows_of_a_kind)
    text += fmt::format("  ... and {} more\n", named.size() - most_rows_of_a_kind);
  for (std::size_t index = 0; index < std::min(never.size(), most_rows_of_a_kind); ++index)
    text += row(*never[index], "  " + never[index]->name, results);
  if (never.size() > most_rows_of_a_kind)
    text += fmt::format("  ... and {} more that never failed\n", never.size() - most_rows_of_a_kind);
  return text;
}

/// The kinds that never happened and have no row, in one sentence.
std::string rest_of(const Results& results) {
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  for (const Outcome& kind : results.kinds)
    if (!has_rows(kind, results)) add(kind.kind);
  if (names.empty()) return "";
  return fmt::format("In none of {} runs (each at most {}): {}\n", results.tried,
                     percent(clopper_pearson(0, results.tried).high), names);
}

std::string commands(const Results& results) {
  if (results.again.empty()) return "";
  std::set<std::uint64_t> seeds;
  if (results.failure) seeds.insert(results.failure->seed);
  for (const Outcome& outcome : results.outcomes)
    if (outcome.runs > 0) seeds.insert(outcome.first_seed);
  if (seeds.empty()) return "";
  std::string text = "Make the first of each again, with a recording:\n";
  std::size_t shown = 0;
  for (const std::uint64_t seed : seeds)
    if (shown++ < most_commands) text += fmt::format("  {} {}\n", results.again, seed);
  if (shown > most_commands) text += fmt::format("  ... and {} more seeds\n", shown - most_commands);
  for (const std::uint64_t seed : results.not_repeated)
    if (seeds.contains(seed))
      text += fmt::format(
          "Seed {} went otherwise when it ran alone: something in the user's code (a global, a static) lasts "
          "from "
          "run to run, so these runs were not independent.\n",
          seed);
  return text;
}

/// Says how many runs had each planted fault. Without the fault, the figures are those of another experiment.
std::string injected(const Results& results) {
  std::string text;
  for (const Injected& one : results.injected) {
    text += fmt::format("injected {}: in {} of {} runs", one.fault, one.runs, results.tried);
    const std::uint64_t unknown = results.tried - one.runs - one.missed;
    text += unknown == 0 ? "\n" : fmt::format(" (not known of {})\n", unknown);
    if (one.runs == 0 && one.missed > 0)
      text += fmt::format(
          "warning: {} has happened in no run: these figures do not show what this fault does.\n", one.fault);
  }
  return text;
}

}  // namespace

std::string percent(double share) {
  if (share > 0 && share < 1e-6) return fmt::format("{:.2e} %", share * 100);
  return fmt::format("{:.3g} %", share * 100);
}

std::string to_table(const Results& results) {
  std::string text = fmt::format("{} of {} schedules from seed {} on", results.tried, results.whole.count(),
                                 results.whole.begin);
  if (results.ran.size() == 1 && results.ran.front() != results.whole)
    text += fmt::format(" ({})", text_of(results.ran.front()));
  text += results.tried == 0    ? ", no run was completed"
          : results.failed == 0 ? ", none fails"
                                : fmt::format(", {} fail", results.failed);
  text += fmt::format(" ({:.1f} s simulated in {:.2f} s, {} firings){}\n", results.simulated_s,
                      results.wall_s, results.firings, results.interrupted ? "; interrupted" : "");
  if (results.tried == 0) return text;
  text += injected(results);
  text += fmt::format("A run fails with a probability of {} ({:.0f} % confidence).\n",
                      interval_text(results.failed, results.tried), usual_confidence * 100);
  text += distribution_rows(results);
  const bool has_any =
      std::ranges::any_of(results.kinds, [&](const Outcome& kind) { return has_rows(kind, results); });
  if (has_any)
    text += fmt::format("\n{:<{}} {:>9} {:>9}   {:<22} {:>10}\n", "", label_width, "runs", "share",
                        "95 % interval", "first seed");
  for (const Outcome& kind : results.kinds)
    if (has_rows(kind, results)) text += rows_of(kind, results);
  if (has_any) text += "\n";
  return text + rest_of(results) + commands(results);
}

}  // namespace tessera::statistics
