#include "statistics/results.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "statistics/clopper_pearson.hpp"

namespace tessera::statistics {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* format_name = "schedules";
constexpr int format_version = 1;

ordered_json to_json(const Interval& interval) { return {interval.low, interval.high}; }
ordered_json to_json(const Seeds& seeds) { return {seeds.begin, seeds.end}; }

ordered_json to_json(const Outcome& outcome, const Results& results) {
  ordered_json written{{"kind", outcome.kind},
                       {"name", outcome.name},
                       {"runs", outcome.runs},
                       {"failed", outcome.failed},
                       {"interval", to_json(clopper_pearson(outcome.runs, results.tried))}};
  if (outcome.runs == 0) return written;
  written["first_seed"] = outcome.first_seed;
  written["at_s"] = outcome.at_s;
  written["text"] = outcome.text;
  if (!results.again.empty()) written["reproduce"] = fmt::format("{} {}", results.again, outcome.first_seed);
  return written;
}

ordered_json to_json(const Distribution& distribution) {
  const SampleCounts::Parts& parts = distribution.samples.parts();
  const auto extreme = [](const SampleCounts::Extreme& one) {
    return ordered_json{{"value", one.value}, {"seed", one.seed}};
  };
  ordered_json written{{"name", distribution.name},
                       {"unit", distribution.unit},
                       {"runs", parts.count},
                       {"sum", parts.sum},
                       {"sum_of_squares", parts.sum_of_squares},
                       {"least", extreme(parts.least)},
                       {"greatest", extreme(parts.greatest)},
                       {"classes", ordered_json::array()}};
  for (const auto& [one, count] : parts.classes)
    written["classes"].push_back(ordered_json::array({one, count}));
  return written;
}

// ---------------------------------------------------------------------------------------------- reading

/// Thrown for numbers that contradict each other.
struct Contradiction : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void demand(bool holds, const char* what) {
  if (!holds) throw Contradiction(what);
}

/// nlohmann::json would turn -1 and 1.5 into some count.
std::uint64_t count_in(const json& value) {
  demand(value.is_number_unsigned(), "a count is no natural number");
  return value.get<std::uint64_t>();
}

double amount_in(const json& value) {
  demand(value.is_number() && value.get<double>() >= 0, "a time is no number from 0 up");
  return value.get<double>();
}

/// Null: not known, as of a process that died.
double instant_in(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : amount_in(value);
}

Seeds seeds_in(const json& value) {
  demand(value.is_array() && value.size() == 2, "seeds are no pair of numbers");
  const Seeds seeds{count_in(value[0]), count_in(value[1])};
  demand(seeds.begin <= seeds.end, "seeds end before they begin");
  return seeds;
}

Outcome outcome_in(const json& value, const Results& results) {
  Outcome outcome{.kind = value.at("kind"),
                  .name = value.at("name"),
                  .runs = count_in(value.at("runs")),
                  .failed = count_in(value.at("failed")),
                  .first_seed = 0,
                  .at_s = 0,
                  .text = {}};
  demand(outcome.runs <= results.tried && outcome.failed <= outcome.runs,
         "something happened in more runs than there were");
  if (outcome.runs == 0) return outcome;
  outcome.first_seed = count_in(value.at("first_seed"));
  outcome.at_s = instant_in(value.at("at_s"));
  outcome.text = value.at("text");
  return outcome;
}

Injected injected_in(const json& value, const Results& results) {
  Injected one{value.at("fault"), count_in(value.at("runs")), count_in(value.at("missed"))};
  demand(one.runs <= results.tried && one.missed <= results.tried - one.runs,
         "a fault was planted in more runs than there were");
  return one;
}

SampleCounts::Extreme extreme_in(const json& value) {
  return {amount_in(value.at("value")), count_in(value.at("seed"))};
}

Distribution distribution_in(const json& value, const Results& results) {
  SampleCounts::Parts parts{.count = count_in(value.at("runs")),
                            .sum = amount_in(value.at("sum")),
                            .sum_of_squares = amount_in(value.at("sum_of_squares")),
                            .least = extreme_in(value.at("least")),
                            .greatest = extreme_in(value.at("greatest")),
                            .classes = {}};
  std::uint64_t count = 0;
  for (const json& one : value.at("classes")) {
    demand(one.is_array() && one.size() == 2 && one[0].is_number_integer(), "a class of numbers is no pair");
    parts.classes[one[0].get<std::int64_t>()] += count_in(one[1]);
    count += count_in(one[1]);
  }
  demand(count == parts.count && count > 0 && count <= results.tried,
         "the numbers of a distribution are not those of the runs");
  Distribution distribution{value.at("name"), value.at("unit"), {}};
  distribution.samples.add(parts);
  return distribution;
}

void read_counts(const json& from, Results& results) {
  for (const json& range : from.at("ran")) results.ran.push_back(seeds_in(range));
  demand(!overlap_of(results.ran), "a seed was run twice");
  results.ran = joined(results.ran);
  std::uint64_t ran = 0;
  for (const Seeds& range : results.ran) ran += range.count();
  results.tried = count_in(from.at("tried"));
  results.failed = count_in(from.at("failed"));
  demand(ran == results.tried, "the number of runs is not that of the seeds");
  demand(results.failed <= results.tried, "more runs failed than there were");
  results.simulated_s = amount_in(from.at("simulated_s"));
  results.wall_s = amount_in(from.at("wall_s"));
  results.firings = count_in(from.at("firings"));
  results.interrupted = from.at("interrupted");
  for (const json& kind : from.at("kinds")) results.kinds.push_back(outcome_in(kind, results));
  for (const json& outcome : from.at("outcomes")) results.outcomes.push_back(outcome_in(outcome, results));
  if (const json& failure = from.at("failure"); !failure.is_null())
    results.failure = {count_in(failure.at("seed")), instant_in(failure.at("at_s")), failure.at("ended")};
  for (const json& seed : from.at("not_repeated")) results.not_repeated.push_back(count_in(seed));
  demand(results.failure.has_value() == (results.failed > 0), "the first failure is not told");
  if (from.contains("injected"))
    for (const json& one : from.at("injected")) results.injected.push_back(injected_in(one, results));
  if (from.contains("ended_by_themselves")) {
    results.ended_by_themselves = count_in(from.at("ended_by_themselves"));
    results.ended_with_failed_check = count_in(from.value("ended_with_failed_check", json(0)));
    demand(
        results.ended_with_failed_check <= std::min(results.failed, *results.ended_by_themselves) &&
            *results.ended_by_themselves - results.ended_with_failed_check <= results.tried - results.failed,
        "more runs ended than there were");
    for (const json& one : from.at("distributions"))
      results.distributions.push_back(distribution_in(one, results));
  }
  if (from.contains("transitions"))
    for (const auto& [name, firings] : from.at("transitions").items())
      results.transitions[name] = count_in(firings);
}

/// The result that `read` fills, or why the text cannot be read. what: "is no result of schedules".
template <class Read>
Result<Results> read_with(std::string_view text, const char* what, Read&& read) {
  try {
    Results results;
    read(json::parse(text), results);
    return results;
  } catch (const Contradiction& contradiction) {
    return Problem{fmt::format("is damaged: {}", contradiction.what())};
  } catch (const json::exception&) {
    return Problem{what};
  }
}

}  // namespace

std::string to_json(const Results& results) {
  ordered_json written{{"tessera", format_name},
                       {"version", format_version},
                       {"system", results.identity.system},
                       {"specification", results.identity.specification},
                       {"net", results.identity.net},
                       {"controller", results.identity.controller},
                       {"settings", results.identity.settings},
                       {"seeds", to_json(results.whole)},
                       {"parts", results.parts},
                       {"ran", ordered_json::array()},
                       {"tried", results.tried},
                       {"failed", results.failed},
                       {"interval", to_json(clopper_pearson(results.failed, results.tried))},
                       {"simulated_s", results.simulated_s},
                       {"wall_s", results.wall_s},
                       {"firings", results.firings},
                       {"interrupted", results.interrupted},
                       {"kinds", ordered_json::array()},
                       {"outcomes", ordered_json::array()},
                       {"failure", nullptr},
                       {"not_repeated", results.not_repeated},
                       {"again", results.again}};
  for (const Seeds& range : results.ran) written["ran"].push_back(to_json(range));
  for (const Outcome& kind : results.kinds) written["kinds"].push_back(to_json(kind, results));
  for (const Outcome& outcome : results.outcomes) written["outcomes"].push_back(to_json(outcome, results));
  if (results.failure) {
    written["failure"] = {
        {"seed", results.failure->seed}, {"at_s", results.failure->at_s}, {"ended", results.failure->ended}};
    if (!results.again.empty())
      written["reproduce"] = fmt::format("{} {}", results.again, results.failure->seed);
  }
  for (const Injected& one : results.injected)
    written["injected"].push_back({{"fault", one.fault}, {"runs", one.runs}, {"missed", one.missed}});
  if (results.ended_by_themselves) {
    written["ended_by_themselves"] = *results.ended_by_themselves;
    written["ended_with_failed_check"] = results.ended_with_failed_check;
    written["distributions"] = ordered_json::array();
    for (const Distribution& one : results.distributions) written["distributions"].push_back(to_json(one));
  }
  if (!results.transitions.empty()) written["transitions"] = results.transitions;
  return written.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

Result<Results> parse_results(std::string_view text) {
  return read_with(text, "is no result of schedules (tessera schedules N --json FILE)",
                   [](const json& from, Results& results) {
                     if (from.at("tessera") != format_name) throw json::other_error::create(501, "", &from);
                     demand(from.at("version") == format_version, "it is of another version of Tessera");
                     results.identity = {from.at("system"), from.at("specification"), from.at("net"),
                                         from.at("controller"), from.at("settings")};
                     results.whole = seeds_in(from.at("seeds"));
                     results.parts = count_in(from.at("parts"));
                     demand(results.parts > 0, "there are no parts");
                     results.again = from.at("again");
                     read_counts(from, results);
                     demand(results.ran.empty() || (results.ran.front().begin >= results.whole.begin &&
                                                    results.ran.back().end <= results.whole.end),
                            "a seed was run that is none of the whole");
                   });
}

Result<Results> parse_counts(std::string_view text) {
  return read_with(text, "is no summary of schedules", [](const json& from, Results& results) {
    results.identity.system = from.at("system");
    results.identity.net = from.at("net_hash");
    read_counts(from, results);
  });
}

}  // namespace tessera::statistics
