#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "rerun/rerun.hpp"

namespace tessera {

std::string rerun_text(const RerunReport& report) {
  std::string text;
  for (const RerunReport::PerSubsystem& one : report.subsystems) {
    std::string differing;
    for (const RerunReport::PerBuffer& output : one.outputs)
      if (output.differing > 0)
        differing +=
            fmt::format(", {} differs after {}", output.path.substr(one.path.size() + 1), output.differing);
    if (one.decisions > 0) differing += fmt::format(", {} decisions differ", one.decisions);
    text += fmt::format("  {}: {} iterations{}\n", one.path, one.iterations,
                        differing.empty() ? ", as recorded" : differing);
  }
  const std::string head =
      fmt::format("{:.3f} s of '{}' run again: ", seconds(report.recorded), report.recording);
  if (!report.first) return head + "the same\n" + text;
  const Difference& first = *report.first;
  return head + "not the same\n" + text +
         fmt::format("first at {:.6f} s: {}, iteration {}: {}: recorded {}, computed {}\n",
                     seconds(first.at.time_since_epoch()), first.subsystem, first.iteration, first.what,
                     first.recorded, first.computed);
}

std::string rerun_json(const RerunReport& report) {
  nlohmann::ordered_json subsystems = nlohmann::ordered_json::array();
  for (const RerunReport::PerSubsystem& one : report.subsystems) {
    nlohmann::ordered_json outputs = nlohmann::ordered_json::object();
    for (const RerunReport::PerBuffer& output : one.outputs) outputs[output.path] = output.differing;
    subsystems.push_back({{"path", one.path},
                          {"iterations", one.iterations},
                          {"differing_decisions", one.decisions},
                          {"differing_outputs", std::move(outputs)}});
  }
  nlohmann::ordered_json json{{"recording", report.recording},
                              {"recorded_s", seconds(report.recorded)},
                              {"same", !report.first.has_value()},
                              {"first", nullptr},
                              {"subsystems", std::move(subsystems)}};
  if (report.first)
    json["first"] = {
        {"subsystem", report.first->subsystem}, {"at_s", seconds(report.first->at.time_since_epoch())},
        {"iteration", report.first->iteration}, {"what", report.first->what},
        {"recorded", report.first->recorded},   {"computed", report.first->computed}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace tessera
