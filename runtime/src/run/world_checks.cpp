#include "run/world_checks.hpp"

#include <fmt/format.h>

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

std::optional<std::string> finish_checks(Assembly& assembly, Time now) {
  if (assembly.world == nullptr) return std::nullopt;
  assembly.judgement = assembly.world->results();
  notice_failed_checks(assembly);
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
