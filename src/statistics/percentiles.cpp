#include "statistics/percentiles.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "statistics/clopper_pearson.hpp"
#include "statistics/table.hpp"

namespace tessera::statistics {
namespace {

constexpr std::array percentiles{0.5, 0.9, 0.99};
constexpr int distribution_label_width = 32;

/// The probability that at most `events` of `runs` happen.
double at_most(std::uint64_t events, std::uint64_t runs, double share) {
  if (events >= runs) return 1;
  return 1 - incomplete_beta(share, static_cast<double>(events) + 1, static_cast<double>(runs - events));
}

/// The least number of events, from 0 to runs, so that at most so many happen with more than that probability.
std::uint64_t least_likely(double probability, std::uint64_t runs, double share) {
  std::uint64_t low = 0, high = runs;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (at_most(middle, runs, share) > probability)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

std::string row(const std::string& label, const std::string& value, const std::string& interval) {
  return fmt::format("{:<{}} {:>19}{}{}\n", label, distribution_label_width, value,
                     interval.empty() ? "" : "   ", interval);
}

std::string shown_number(double value) { return fmt::format("{:.4g}", value); }

std::string interval_of(const SampleCounts& samples, double share) {
  const Ranks ranks = ranks_of_percentile(share, samples.parts().count, usual_confidence);
  if (!ranks.low && !ranks.high) return "too few runs";
  if (!ranks.high) return fmt::format("at least {}", shown_number(samples.at_rank(*ranks.low)));
  if (!ranks.low) return fmt::format("at most {}", shown_number(samples.at_rank(*ranks.high)));
  return fmt::format("{} to {}", shown_number(samples.at_rank(*ranks.low)),
                     shown_number(samples.at_rank(*ranks.high)));
}

std::string rows_of(const Distribution& distribution) {
  const SampleCounts& samples = distribution.samples;
  const SampleCounts::Parts& parts = samples.parts();
  std::string text =
      fmt::format("\n{:<{}} {:>19}   95 % interval\n",
                  distribution.name + (distribution.unit.empty() ? "" : ", " + distribution.unit),
                  distribution_label_width, "");
  if (parts.count > 1) {
    constexpr double normal_quantile = 1.959964;  // of 95 %, two-sided
    const double half = normal_quantile * samples.deviation() / std::sqrt(static_cast<double>(parts.count));
    text += row("  mean", shown_number(samples.mean()),
                fmt::format("{:.5g} to {:.5g}", samples.mean() - half, samples.mean() + half));
    text += row("  standard deviation", shown_number(samples.deviation()), "");
  }
  for (const double share : percentiles)
    text += row(fmt::format("  {:g} % of the runs at most", share * 100),
                shown_number(samples.at_rank(
                    static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(parts.count))))),
                interval_of(samples, share));
  return text + fmt::format("  least {} (seed {}), greatest {} (seed {})\n", shown_number(parts.least.value),
                            parts.least.seed, shown_number(parts.greatest.value), parts.greatest.seed);
}

}  // namespace

Ranks ranks_of_percentile(double share, std::uint64_t count, double confidence) {
  // The percentile lies under the sample of rank r if less than r samples are below it: P(B < r).
  const double outside = (1 - confidence) / 2;
  Ranks ranks;
  const std::uint64_t low = least_likely(outside, count, share);
  if (low > 0) ranks.low = low;
  const std::uint64_t high = least_likely(1 - outside, count, share) + 1;
  if (high <= count) ranks.high = high;
  return ranks;
}

std::string distribution_rows(const Results& results) {
  std::string text;
  const std::uint64_t ended = results.ended_by_themselves.value_or(0);
  if (ended > 0) {
    const std::uint64_t others = results.tried - ended;
    const Interval late = clopper_pearson(others, results.tried);
    const auto limit = results.identity.settings.find("for");
    text += fmt::format(
        "{} of {} runs ended by themselves{}; the others: {} ({} to {}), of which {} failed\n", ended,
        results.tried, limit == results.identity.settings.end() ? "" : " within " + limit->second,
        percent(static_cast<double>(others) / static_cast<double>(results.tried)), percent(late.low),
        percent(late.high), results.failed - results.ended_with_failed_check);
  }
  for (const Distribution& one : results.distributions) text += rows_of(one);
  return text.empty() ? text : text + "\n";
}

}  // namespace tessera::statistics
