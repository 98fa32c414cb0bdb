#include "run/summary_text.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "tessera/judgement.hpp"

namespace tessera {

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
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

std::string summary_lines(const RunSummary& summary) {
  std::string text = fmt::format("{} after {:.3f} s: {} firings\n", summary.ended, seconds(summary.simulated),
                                 summary.firings);
  for (const RunSummary::PerSubsystem& subsystem : summary.subsystems)
    fmt::format_to(std::back_inserter(text), "  {}: {} iterations, {} overruns, {} errors\n", subsystem.path,
                   subsystem.iterations, subsystem.overruns, subsystem.errors);
  return text + judgement_lines(summary.judgement);
}

}  // namespace tessera
