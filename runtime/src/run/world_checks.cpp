#include "run/world_checks.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "system/console.hpp"

namespace tessera {
namespace {

Time time_of(const WorldFailure& failure) {
  return Time(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(failure.time_s)));
}

}  // namespace

void notice_failed_checks(Assembly& assembly) {
  for (WorldFailure& failure : assembly.world->take_failures()) {
    console::print(LogLevel::error, time_of(failure), "tessera",
                   fmt::format("the check '{}' has failed: {}", failure.check, failure.text));
    assembly.failed_checks.push_back(std::move(failure));
  }
}

void record_failed_checks(Assembly& assembly, Time now) {
  RecordingLane* lane = assembly.recorder == nullptr ? nullptr : assembly.recorder->system_lane();
  for (; assembly.recorded_checks < assembly.failed_checks.size(); ++assembly.recorded_checks) {
    const WorldFailure& failure = assembly.failed_checks[assembly.recorded_checks];
    if (lane != nullptr)
      lane->text(Event::Kind::fault, now, static_cast<std::uint32_t>(Fault::assertion),
                 fmt::format("{}: at {:.3f} s, {}", failure.check, failure.time_s, failure.text));
  }
}

std::string finish_checks(Assembly& assembly, Time now) {
  if (assembly.world == nullptr) return {};
  assembly.judgement = assembly.world->results();
  notice_failed_checks(assembly);
  record_failed_checks(assembly, now);
  const std::vector<WorldFailure>& failed = assembly.failed_checks;
  if (failed.empty()) return {};
  std::string text =
      failed.size() == 1 ? "; a check failed: " : fmt::format("; {} checks failed: ", failed.size());
  for (const WorldFailure& failure : failed)
    text += (&failure == &failed.front() ? "" : ", ") + failure.check;
  return text;
}

std::string text_of_judgement(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return {};
  std::string lines;
  const auto out = std::back_inserter(lines);
  for (const auto& check : json.value("checks", nlohmann::json::array())) {
    fmt::format_to(out, "  check {}: {}", check.value("name", ""), check.value("verdict", ""));
    if (check.contains("time_s")) fmt::format_to(out, " at {:.3f} s", check["time_s"].get<double>());
    if (check.contains("detail")) fmt::format_to(out, "; {}", check["detail"].get<std::string>());
    lines += '\n';
  }
  const nlohmann::json measures = json.value("measures", nlohmann::json::object());
  for (const auto& [name, measure] : measures.items()) {
    if (!measure.is_object()) continue;
    fmt::format_to(out, "  {}: {:.6g} (at {:.3f} s) to {:.6g} (at {:.3f} s), mean {:.6g}\n", name,
                   measure["least"].get<double>(), measure["least_at_s"].get<double>(),
                   measure["greatest"].get<double>(), measure["greatest_at_s"].get<double>(),
                   measure["mean"].get<double>());
  }
  return lines;
}

}  // namespace tessera
