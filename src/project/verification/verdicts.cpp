#include "project/verification/verdicts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

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
          {"hint", property.hint},
          {"cut_off", property.cut_off}};
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
    property.behaviours.push_back({one.at("path").get<std::string>(), one.at("line").get<std::uint32_t>(),
                                   one.value("included", std::string())});
  kept.at("seconds").get_to(property.seconds);
  kept.at("states").get_to(property.states);
  kept.at("warning").get_to(property.warning);
  kept.at("exceptions").get_to(property.exceptions);
  property.partition = kept.value("partition", false);
  property.hint = kept.value("hint", std::string());
  property.cut_off = kept.value("cut_off", std::string());
  return property;
}

/// The file of the verdicts with that hash. It is in a folder of the user: one in the project could come with
/// the project, and say of a net that deadlocks that it does not.
class Kept {
 public:
  explicit Kept(const std::string& hash) : hash_(hash) {
    if (const std::optional<fs::path> folder = user_folder()) file_ = *folder / "verdicts" / (hash + ".json");
  }

  /// nullopt: there are none, or more time might decide what they leave unknown, or show more.
  [[nodiscard]] std::optional<verify::Report> read(double seconds) const try {
    if (!is_kept_by_user(file_)) return std::nullopt;
    const json kept = json::parse(content_of(file_));
    verify::Report report;
    kept.at("net_hash").get_to(report.net_hash);
    kept.at("verification_hash").get_to(report.verification_hash);
    for (const json& property : kept.at("properties")) report.properties.push_back(property_from(property));
    if (report.verification_hash != hash_ || report.properties.empty()) return std::nullopt;
    const bool undecided = std::ranges::any_of(report.properties, [](const verify::PropertyResult& property) {
      return property.verdict == verify::Verdict::unknown || !property.cut_off.empty();
    });
    if (undecided && kept.at("seconds").get<double>() < seconds) return std::nullopt;
    return report;
  } catch (const std::exception&) {
    return std::nullopt;
  }

  void write(const verify::Report& report, double seconds) const {
    if (file_.empty()) return;
    json properties = json::array();
    for (const verify::PropertyResult& property : report.properties) properties.push_back(to_json(property));
    const json kept{{"net_hash", report.net_hash},
                    {"verification_hash", report.verification_hash},
                    {"seconds", seconds},
                    {"properties", properties}};
    try {
      keep_for_user(file_, kept.dump(1) + "\n");
      remove_old();
    } catch (const std::exception&) {  // they are computed again next time
    }
  }

 private:
  /// Removes the files that were written first, if there are more than a user can work on.
  void remove_old() const {
    constexpr std::size_t most = 1000;
    std::vector<std::pair<fs::file_time_type, fs::path>> all;
    for (const fs::directory_entry& entry : fs::directory_iterator(file_.parent_path()))
      if (entry.path().extension() == ".json") all.emplace_back(entry.last_write_time(), entry.path());
    if (all.size() <= most) return;
    std::ranges::sort(all);
    for (std::size_t index = 0; index < all.size() - most; ++index) fs::remove(all[index].second);
  }

  std::string hash_;
  fs::path file_;  ///< empty: none is kept
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
  const Kept kept(verify::verification_hash(subject));
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
