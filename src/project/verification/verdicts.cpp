#include "project/verification/verdicts.hpp"

#include <fmt/core.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "layers/layers.hpp"
#include "project/files/files.hpp"
#include "project/files/state_folder.hpp"
#include "project/process/listener.hpp"
#include "project/verification/run_files.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

using nlohmann::json;

json to_json(const verify::PropertyResult& property) {
  json trace = json::array();
  for (const net::TransitionId id : property.trace) trace.push_back(id.value);
  return {{"name", property.name},
          {"asks", property.asks},
          {"verdict", static_cast<int>(property.verdict)},
          {"method", property.method},
          {"why", property.why},
          {"meaning", property.meaning},
          {"explanation", property.explanation},
          {"trace", trace},
          {"has_trace", property.has_trace},
          {"waits", at_end_json(property.waits)},
          {"behaviours", behaviours_json(property)},
          {"seconds", property.seconds},
          {"states", property.states},
          {"warning", property.warning},
          {"exceptions", property.exceptions},
          {"partition", property.partition},
          {"hint", property.hint}};
}

verify::PropertyResult property_from(const json& kept) {
  verify::PropertyResult property;
  kept.at("name").get_to(property.name);
  kept.at("asks").get_to(property.asks);
  const int verdict = kept.at("verdict").get<int>();
  if (verdict < 0 || verdict > 2) throw std::runtime_error("no verdict");
  property.verdict = static_cast<verify::Verdict>(verdict);
  kept.at("method").get_to(property.method);
  kept.at("why").get_to(property.why);
  kept.at("meaning").get_to(property.meaning);
  kept.at("explanation").get_to(property.explanation);
  for (const json& id : kept.at("trace")) property.trace.push_back({id.get<std::uint32_t>()});
  kept.at("has_trace").get_to(property.has_trace);
  property.waits = at_end_from(kept.at("waits"));
  for (const json& one : kept.at("behaviours"))
    property.behaviours.push_back({one.at("path").get<std::string>(), one.at("line").get<std::uint32_t>()});
  kept.at("seconds").get_to(property.seconds);
  kept.at("states").get_to(property.states);
  kept.at("warning").get_to(property.warning);
  kept.at("exceptions").get_to(property.exceptions);
  property.partition = kept.value("partition", false);
  property.hint = kept.value("hint", std::string());
  return property;
}

/// The file of the verdicts with that hash.
class Kept {
 public:
  Kept(const Specification& specification, const std::string& hash)
      : hash_(hash), name_(fs::path("verdicts") / (hash + ".json")), project_(specification.project) {}

  /// nullopt: there are none, or more time might decide what they leave unknown.
  [[nodiscard]] std::optional<verify::Report> read(double seconds) const try {
    const fs::path ours = state_folder(project_) / name_;
    std::error_code ignored;
    const json kept =
        json::parse(content_of(fs::exists(ours, ignored) ? ours : own_folder(project_) / name_));
    verify::Report report;
    kept.at("net_hash").get_to(report.net_hash);
    kept.at("verification_hash").get_to(report.verification_hash);
    for (const json& property : kept.at("properties")) report.properties.push_back(property_from(property));
    if (report.verification_hash != hash_ || report.properties.empty()) return std::nullopt;
    const bool undecided = std::ranges::any_of(report.properties, [](const verify::PropertyResult& property) {
      return property.verdict == verify::Verdict::unknown;
    });
    if (undecided && kept.at("seconds").get<double>() < seconds) return std::nullopt;
    return report;
  } catch (const std::exception&) {
    return std::nullopt;
  }

  void write(const verify::Report& report, double seconds) const {
    json properties = json::array();
    for (const verify::PropertyResult& property : report.properties) properties.push_back(to_json(property));
    const json kept{{"net_hash", report.net_hash},
                    {"verification_hash", report.verification_hash},
                    {"seconds", seconds},
                    {"properties", properties}};
    try {
      write_file(state_folder(project_) / name_, kept.dump(1) + "\n");
    } catch (const std::exception&) {  // they are computed again next time
    }
  }

 private:
  std::string hash_;
  fs::path name_, project_;
};

std::string shown(const explore::Progress& progress) {
  return fmt::format("{:.2f} M markings, {:.2f} M/s", static_cast<double>(progress.markings) / 1e6,
                     progress.markings_per_second / 1e6);
}

}  // namespace

double parse_seconds(const std::string& text, const std::string& option) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  const double scale = unit.empty() || unit == "s" ? 1 : unit == "ms" ? 0.001 : unit == "min" ? 60 : 0;
  if (error != std::errc() || value < 0 || scale == 0)
    throw std::runtime_error(option + ": '" + text + "' is no time, such as 60s, 500ms or 2min");
  return value * scale;
}

verify::Report verify_or_recall(const Specification& specification, const Nets& nets,
                                const VerificationGate& gate, Listener& listener) {
  const double seconds = parse_seconds(gate.timeout, "--verify-timeout");
  const std::vector<net::Invariant> invariants =
      layers::invariants(specification.model, nets.pages, nets.flat);
  const verify::Subject subject{nets.flat, &nets.pages, invariants, nets.properties};
  const Kept kept(specification, verify::verification_hash(subject));
  if (std::optional<verify::Report> report = kept.read(seconds)) return std::move(*report);
  Step step(listener, "verifying");
  verify::ProveOptions how;
  how.time = std::chrono::duration<double>(seconds);
  how.progress = [&](const std::string& property, const explore::Progress& progress) {
    step.progress(property + ": " + shown(progress));
  };
  verify::Report report = verify::prove(subject, how);
  kept.write(report, seconds);
  return report;
}

}  // namespace tessera::project
