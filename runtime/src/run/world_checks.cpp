#include "run/world_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "assembly/run_accounts.hpp"
#include "system/console.hpp"

namespace tessera {
namespace {

Time time_of(const WorldFailure& failure) {
  return Time(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(failure.time_s)));
}

void print_failure(const WorldFailure& failure) {
  console::print(LogLevel::error, time_of(failure), "tessera",
                 fmt::format("the check '{}' has failed: {}", failure.check, failure.text));
}

/// "956.8 J"; "3" of something that has no unit.
[[nodiscard]] std::string amount_text(double amount, const std::string& unit) {
  return fmt::format("{:.6g}{}{}", amount, unit.empty() ? "" : " ", unit);
}

/// Adds the checks of what the run has used to the judgement of its world. One process of several knows its own part
/// only, so that they stay open there.
void judge_uses(Assembly& assembly, Time now) {
  if (assembly.options.use_checks.empty()) return;
  using nlohmann::ordered_json;
  ordered_json judgement =
      assembly.judgement.empty() ? ordered_json::object() : ordered_json::parse(assembly.judgement);
  const std::vector<RunSummary::Used> used = used_resources(assembly, now);
  for (const RunOptions::UseCheck& check : assembly.options.use_checks) {
    const auto found = std::ranges::find(used, check.resource, &RunSummary::Used::resource);
    const bool is_known = found != used.end() && assembly.options.network.process.empty();
    const std::string text = fmt::format("at_most: {} {}", check.resource,
                                         amount_text(check.most, found == used.end() ? "" : found->unit));
    const bool failed = is_known && found->amount > check.most;
    const char* const verdict = failed ? "failed" : "held";
    ordered_json result{{"name", check.name}, {"text", text}, {"verdict", is_known ? verdict : "open"}};
    if (failed) {
      const std::string detail = amount_text(found->amount, found->unit) + " used";
      result["detail"] = detail;
      WorldFailure failure{check.name, fmt::format("{} ({})", detail, text), seconds(now.time_since_epoch())};
      print_failure(failure);
      assembly.failed_checks.push_back(std::move(failure));
    }
    judgement["checks"].push_back(std::move(result));
  }
  assembly.judgement = judgement.dump();
}

}  // namespace

void notice_failed_checks(Assembly& assembly) {
  for (WorldFailure& failure : assembly.world->take_failures()) {
    print_failure(failure);
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

std::optional<std::string> finish_checks(Assembly& assembly, Time now) {
  if (assembly.world != nullptr) {
    assembly.judgement = assembly.world->results();
    notice_failed_checks(assembly);
  }
  judge_uses(assembly, now);
  record_failed_checks(assembly, now);
  const std::vector<WorldFailure>& failed = assembly.failed_checks;
  if (failed.empty()) return std::nullopt;
  std::string text =
      failed.size() == 1 ? "; a check failed: " : fmt::format("; {} checks failed: ", failed.size());
  for (const WorldFailure& failure : failed)
    text += (&failure == &failed.front() ? "" : ", ") + failure.check;
  return text;
}

}  // namespace tessera
