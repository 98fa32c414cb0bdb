#include "run/summary_text.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "tessera/judgement.hpp"

namespace tessera {
namespace {

nlohmann::ordered_json used_json(const std::vector<RunSummary::Used>& all) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const RunSummary::Used& one : all) {
    nlohmann::ordered_json& row = json.emplace_back(
        nlohmann::ordered_json{{"resource", one.resource}, {"unit", one.unit}, {"amount", one.amount}});
    for (const auto& [agent, amount] : one.agents) row["agents"][agent] = amount;
  }
  return json;
}

/// Members without a value are left out.
nlohmann::ordered_json chain_json(const ChainTimes& chain) {
  nlohmann::ordered_json json{
      {"name", chain.name}, {"members", chain.members}, {"commands", chain.commands}, {"over", chain.over}};
  const auto put = [&](const char* name, std::optional<Duration> time) {
    if (time) json[name] = seconds(*time);
  };
  put("longest_age_s", chain.longest_age);
  put("longest_reaction_s", chain.longest_reaction);
  put("proved_age_s", chain.proved_age);
  put("proved_reaction_s", chain.proved_reaction);
  return json;
}

std::string chain_line(const ChainTimes& chain) {
  if (!chain.longest_age) return fmt::format("  {}: no command is based on a reading\n", chain.name);
  const auto times = [](const char* what, std::optional<Duration> measured, std::optional<Duration> proved) {
    if (!measured) return std::string();
    return fmt::format("{} at most {:.6g} ms measured, {}", what, seconds(*measured) * 1e3,
                       proved ? fmt::format("{:.6g} ms proved", seconds(*proved) * 1e3) : "nothing proved");
  };
  const std::string reaction = times("; reaction", chain.longest_reaction, chain.proved_reaction);
  return fmt::format("  {}: {}{}\n", chain.name, times("age", chain.longest_age, chain.proved_age), reaction);
}

}  // namespace

std::string summary_json(const RunSummary& summary, const RunOptions& options) {
  const double simulated_s = seconds(summary.simulated);
  nlohmann::ordered_json json{
      {"simulated_s", simulated_s},
      {"wall_s", summary.wall_s},
      {"real_time_factor", summary.wall_s > 0 ? simulated_s / summary.wall_s : 0.0},
      {"firings", summary.firings},
      {"ended", summary.ended},
      {"failed", summary.failed},
      {"signal", summary.signal},
      {"recording", options.recording},
      {"lost_events", summary.lost_events},
      {"lines_not_printed", summary.lines_not_printed},
      {"warnings", summary.warnings},
  };
  if (summary.recorded_from) json["recorded_from_s"] = seconds(*summary.recorded_from);
  if (summary.world_time) json["world_s"] = seconds(*summary.world_time);
  if (options.world && !options.world->track.empty()) json["track"] = options.world->track;
  const auto judgement =
      nlohmann::ordered_json::parse(summary.judgement, nullptr, /*allow_exceptions=*/false);
  if (judgement.is_object()) json.update(judgement);
  for (const RunSummary::PlantedFault& fault : summary.injected)
    json["injected"].push_back({{"fault", fault.text}, {"happened", fault.happened}});
  if (!summary.used.empty()) json["used"] = used_json(summary.used);
  json["subsystems"] = nlohmann::ordered_json::array();
  for (const RunSummary::PerSubsystem& subsystem : summary.subsystems)
    json["subsystems"].push_back({{"path", subsystem.path},
                                  {"iterations", subsystem.iterations},
                                  {"overruns", subsystem.overruns},
                                  {"errors", subsystem.errors},
                                  {"slow_calls", subsystem.slow_calls},
                                  {"late_wakeups", subsystem.late_wakeups},
                                  {"latest_wakeup_s", seconds(subsystem.latest_wakeup)}});
  for (const RunSummary::SlowCalls& one : summary.overtime)
    json["overtime"].push_back({{"behaviour", one.behaviour},
                                {"calls", one.calls},
                                {"slow", one.slow},
                                {"declared_ns", one.declared.count()},
                                {"longest_ns", one.longest.count()},
                                {"longest_at_ns", one.longest_at.time_since_epoch().count()}});
  for (const ChainTimes& chain : summary.chains) json["chains"].push_back(chain_json(chain));
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

std::string summary_lines(const RunSummary& summary) {
  std::string text = fmt::format("{} after {:.3f} s: {} firings\n", summary.ended, seconds(summary.simulated),
                                 summary.firings);
  for (const RunSummary::PerSubsystem& subsystem : summary.subsystems)
    fmt::format_to(std::back_inserter(text), "  {}: {} iterations, {} overruns, {} errors\n", subsystem.path,
                   subsystem.iterations, subsystem.overruns, subsystem.errors);
  for (const ChainTimes& chain : summary.chains) text += chain_line(chain);
  return text + judgement_lines(summary.judgement) +
         judgement_lines(nlohmann::ordered_json{{"used", used_json(summary.used)}}.dump());
}

}  // namespace tessera
