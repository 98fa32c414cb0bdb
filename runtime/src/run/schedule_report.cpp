#include "run/schedule_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "recorder/run_tally.hpp"
#include "tessera/recording.hpp"

namespace tessera {
namespace {

using nlohmann::ordered_json;

constexpr auto invalid_text_replaced = ordered_json::error_handler_t::replace;

constexpr double unknown_time = std::numeric_limits<double>::quiet_NaN();  // null in JSON

void count_event(ScheduleOutcome& outcome, const ScheduleResult& result, const ScheduleEvent& event) {
  ++outcome.runs;
  if (result.failed) ++outcome.failed;
  if (outcome.runs > 1 && outcome.first_seed <= result.seed) return;
  outcome.first_seed = result.seed;
  outcome.at_s = event.at_s;
  outcome.text = event.text;
}

/// Keeps the ranges sorted and apart.
void insert_seed(std::vector<SeedRange>& ranges, std::uint64_t seed) {
  const auto after = std::ranges::upper_bound(ranges, seed, {}, &SeedRange::begin);
  const bool extends = after != ranges.begin() && std::prev(after)->end == seed;
  const bool precedes = after != ranges.end() && after->begin == seed + 1;
  if (extends && precedes) {
    std::prev(after)->end = after->end;
    ranges.erase(after);
  } else if (extends) {
    std::prev(after)->end = seed + 1;
  } else if (precedes) {
    after->begin = seed;
  } else {
    ranges.insert(after, {seed, seed + 1});
  }
}

[[nodiscard]] ordered_json outcome_json(const std::string& kind, const std::string& name,
                                        const ScheduleOutcome& outcome) {
  ordered_json json{{"kind", kind}, {"name", name}, {"runs", outcome.runs}, {"failed", outcome.failed}};
  if (outcome.runs == 0) return json;
  json["first_seed"] = outcome.first_seed;
  json["at_s"] = outcome.at_s;
  json["text"] = outcome.text;
  return json;
}

[[nodiscard]] ordered_json distribution_json(const ScheduleReport::Distribution& one) {
  const SampleCounts::Parts& parts = one.samples.parts();
  const auto extreme = [](const SampleCounts::Extreme& of) {
    return ordered_json{{"value", of.value}, {"seed", of.seed}};
  };
  ordered_json json{{"name", one.name},
                    {"unit", one.unit},
                    {"runs", parts.count},
                    {"sum", parts.sum},
                    {"sum_of_squares", parts.sum_of_squares},
                    {"least", extreme(parts.least)},
                    {"greatest", extreme(parts.greatest)},
                    {"classes", ordered_json::array()}};
  for (const auto& [at, count] : parts.classes) json["classes"].push_back(ordered_json::array({at, count}));
  return json;
}

}  // namespace

const std::vector<std::string>& schedule_event_kinds() {
  static const std::vector<std::string> kinds = [] {
    std::vector<std::string> all;
    for (const Fault fault :
         {Fault::assertion, Fault::net, Fault::exception, Fault::not_finite, Fault::device, Fault::limit,
          Fault::stale, Fault::stall, Fault::overrun, Fault::overtime})
      all.emplace_back(name_of(fault));
    for (const char* other :
         {"deadlock", "stuck for good", "scenario", "unsafe device", "world", "crash", "no start", "other"})
      all.emplace_back(other);
    return all;
  }();
  return kinds;
}

ScheduleReport::ScheduleReport() {
  for (const std::string& kind : schedule_event_kinds()) kinds.emplace(kind, ScheduleOutcome{});
}

void ScheduleReport::add(const ScheduleResult& result) {
  ++tried;
  simulated += result.simulated;
  firings += result.firings;
  insert_seed(ran, result.seed);
  for (const auto& [text, happened] : result.injected)
    ++(happened ? injected[text].runs : injected[text].missed);
  std::map<std::string_view, const ScheduleEvent*> first;  // of each kind
  for (const ScheduleEvent& event : result.events) {
    count_event(outcomes[{event.kind, event.name}], result, event);
    const ScheduleEvent*& earliest = first[event.kind];
    if (earliest == nullptr || event.at_s < earliest->at_s) earliest = &event;
  }
  for (const auto& [kind, event] : first) count_event(kinds[std::string(kind)], result, *event);
  // A check that only the long runs fail must not take them out of the distribution.
  if (!result.failed || result.only_check_failed) {
    if (result.ended_by_itself) {
      ++ended_by_themselves;
      if (result.failed) ++ended_with_failed_check;
      count("time", "s", seconds(result.simulated), result.seed);
    }
    for (const ScheduleResult::Used& used : result.used)
      count(used.resource, used.unit, used.amount, result.seed);
  }
  if (!result.failed) return;
  ++failed;
  const bool is_known_when = result.events.empty() || !std::isnan(result.events.front().at_s);
  if (!first_failure || result.seed < first_failure->seed)
    first_failure = {result.seed, is_known_when ? seconds(result.simulated) : unknown_time, result.ended};
}

void ScheduleReport::count(const std::string& name, const std::string& unit, double value,
                           std::uint64_t seed) {
  auto found = std::ranges::find_if(
      distributions, [&](const Distribution& one) { return one.name == name && one.unit == unit; });
  if (found == distributions.end()) found = distributions.insert(found, {name, unit, {}});
  found->samples.add(value, seed);
}

void ScheduleReport::add_checks(const RunOptions& options) {
  const auto add = [this](std::string_view name) {
    outcomes.try_emplace({std::string(name_of(Fault::assertion)), std::string(name_in_fault(name))});
  };
  for (const RunOptions::UseCheck& check : options.use_checks) add(check.name);
  if (!options.world || options.world->checks.empty()) return;
  const auto json = nlohmann::json::parse(options.world->checks);
  if (!json.contains("checks")) return;
  for (const auto& check : json.at("checks")) add(check.at("name").get_ref<const std::string&>());
}

std::string schedules_text(const ScheduleReport& report) {
  std::string text =
      fmt::format("{} of {} schedules from seed {} on, {} ({:.1f} s simulated in {:.2f} s, {} firings){}\n",
                  report.tried, report.asked, report.first_seed,
                  report.failed == 0 ? std::string("none fails") : fmt::format("{} fail", report.failed),
                  seconds(report.simulated), report.wall_s, report.firings,
                  report.interrupted == 0 ? "" : "; interrupted");
  if (report.ended_by_themselves > 0)
    text += fmt::format("  {} of {} runs ended by themselves\n", report.ended_by_themselves, report.tried);
  for (const ScheduleReport::Distribution& one : report.distributions)
    text += fmt::format(
        "  {}: mean {:.6g} {unit}, least {:.6g} {unit} (seed {}), greatest {:.6g} {unit} (seed {})\n",
        one.name, one.samples.mean(), one.samples.parts().least.value, one.samples.parts().least.seed,
        one.samples.parts().greatest.value, one.samples.parts().greatest.seed, fmt::arg("unit", one.unit));
  for (const auto& [fault, count] : report.injected)
    text += fmt::format("  injected {}: in {} of {} runs\n", fault, count.runs, report.tried);
  for (const auto& [key, outcome] : report.outcomes) {
    if (outcome.runs == 0) {
      text += fmt::format("  {} {}: in none of {} runs\n", key.first, key.second, report.tried);
      continue;
    }
    text +=
        fmt::format("  {}{}{}: in {} of {} runs; first seed {}{}: {}\n", key.first,
                    key.second.empty() ? "" : " ", key.second, outcome.runs, report.tried, outcome.first_seed,
                    std::isnan(outcome.at_s) ? "" : fmt::format(" at {:.6f} s", outcome.at_s), outcome.text);
  }
  return text;
}

std::string schedules_json(const ScheduleReport& report) {
  ordered_json json{{"system", report.system},
                    {"net_hash", report.net_hash},
                    {"asked", report.asked},
                    {"tried", report.tried},
                    {"failed", report.failed},
                    {"first_seed", report.first_seed},
                    {"ran", ordered_json::array()},
                    {"jobs", report.jobs},
                    {"simulated_s", seconds(report.simulated)},
                    {"wall_s", report.wall_s},
                    {"firings", report.firings},
                    {"interrupted", report.interrupted != 0},
                    {"kinds", ordered_json::array()},
                    {"outcomes", ordered_json::array()},
                    {"failure", nullptr},
                    {"not_repeated", report.not_repeated}};
  for (const SeedRange& range : report.ran) json["ran"].push_back({range.begin, range.end});
  for (const std::string& kind : schedule_event_kinds())
    json["kinds"].push_back(outcome_json(kind, "", report.kinds.at(kind)));
  for (const auto& [key, outcome] : report.outcomes)
    json["outcomes"].push_back(outcome_json(key.first, key.second, outcome));
  if (report.first_failure)
    json["failure"] = {{"seed", report.first_failure->seed},
                       {"at_s", report.first_failure->at_s},
                       {"ended", report.first_failure->ended}};
  for (const auto& [fault, count] : report.injected)
    json["injected"].push_back({{"fault", fault}, {"runs", count.runs}, {"missed", count.missed}});
  json["ended_by_themselves"] = report.ended_by_themselves;
  json["ended_with_failed_check"] = report.ended_with_failed_check;
  json["distributions"] = ordered_json::array();
  for (const ScheduleReport::Distribution& one : report.distributions)
    json["distributions"].push_back(distribution_json(one));
  if (!report.transitions.empty()) {
    json["transitions"] = ordered_json::object();
    for (const auto& [name, firings] : report.transitions) json["transitions"][name] = firings;
  }
  return json.dump(2, ' ', false, invalid_text_replaced) + '\n';
}

std::string to_line(const ScheduleResult& result) {
  ordered_json events = ordered_json::array();
  for (const ScheduleEvent& event : result.events)
    events.push_back({event.kind, event.name, event.at_s, event.text});
  ordered_json injected = ordered_json::array();
  for (const auto& [text, happened] : result.injected)
    injected.push_back(ordered_json::array({text, happened}));
  ordered_json used = ordered_json::array();
  for (const ScheduleResult::Used& one : result.used)
    used.push_back(ordered_json::array({one.resource, one.unit, one.amount}));
  const ordered_json line{result.seed,
                          result.failed,
                          result.interrupted,
                          result.simulated.count(),
                          result.firings,
                          result.ended,
                          std::move(events),
                          std::move(injected),
                          result.ended_by_itself,
                          std::move(used),
                          result.only_check_failed};
  return line.dump(-1, ' ', false, invalid_text_replaced);
}

std::optional<ScheduleResult> from_line(std::string_view line) try {
  const auto json = nlohmann::json::parse(line);
  ScheduleResult result{.seed = json.at(0),
                        .failed = json.at(1),
                        .interrupted = json.at(2),
                        .simulated = Duration(json.at(3).get<std::int64_t>()),
                        .firings = json.at(4),
                        .ended = json.at(5),
                        .events = {}};
  for (const auto& event : json.at(6))
    result.events.push_back(
        {.kind = event.at(0), .name = event.at(1), .at_s = event.at(2), .text = event.at(3)});
  for (const auto& fault : json.at(7)) result.injected.push_back({fault.at(0), fault.at(1)});
  result.ended_by_itself = json.at(8);
  for (const auto& one : json.at(9)) result.used.push_back({one.at(0), one.at(1), one.at(2)});
  result.only_check_failed = json.at(10);
  return result;
} catch (const nlohmann::json::exception&) {
  return std::nullopt;
}

}  // namespace tessera
