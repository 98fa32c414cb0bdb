#include "watch/ros2_host.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "drivers/ros2_library.hpp"
#include "nets/flat_net.hpp"
#include "parameters/ros2_parameters.hpp"
#include "system/console.hpp"
#include "tessera/device.hpp"
#include "watch/snapshot.hpp"

namespace tessera {
namespace {

constexpr std::string_view holds_verdict = "holds";  // as the generator writes it

/// Raises the level of a status and adds a reason.
void worsen(Ros2Status& status, Ros2Status::Level level, const std::string& why) {
  status.level = std::max(status.level, level);
  status.message += (status.message.empty() ? "" : "; ") + why;
}

}  // namespace

std::vector<Ros2Status> Ros2Statuses::of(const Snapshot& snapshot) {
  using Level = Ros2Status::Level;
  std::vector<Ros2Status> all;
  for (const Snapshot::Subsystem& one : snapshot.subsystems) {
    Ros2Status& status = all.emplace_back();
    status.path = one.path;
    if (snapshot.emergency) worsen(status, Level::error, "emergency stop: " + *snapshot.emergency);
    if (one.errors > 0)
      worsen(status, Level::error, fmt::format("{} fault{}", one.errors, one.errors == 1 ? "" : "s"));
    const auto last = overruns_.find(one.path);
    if (const std::uint64_t before = last == overruns_.end() ? 0 : last->second; one.overruns > before)
      worsen(status, Level::warn,
             fmt::format("{} new overrun{}", one.overruns - before, one.overruns - before == 1 ? "" : "s"));
    overruns_[one.path] = one.overruns;
    const std::uint64_t overtimes = one.slow_calls + one.late_wakeups;
    if (const std::uint64_t before = std::exchange(overtimes_[one.path], overtimes); overtimes > before)
      worsen(status, Level::warn, fmt::format("overtime: {} new", overtimes - before));
    for (const Snapshot::Wait& wait : snapshot.waits)  // may be what it should do
      if (wait.subsystem == one.path)
        worsen(status, Level::ok,
               fmt::format("waits for {} ({:.1f} s)", wait.waits_for, snapshot.time_s - wait.since_s));
    if (one.ended) worsen(status, status.level == Level::ok ? Level::stale : status.level, "has ended");
    if (status.message.empty()) status.message = one.behaviour.value_or("has not begun");
    status.values = {{"behaviour", one.behaviour.value_or("")},
                     {"iterations", std::to_string(one.iterations)},
                     {"firings", std::to_string(one.firings)},
                     {"overruns", std::to_string(one.overruns)},
                     {"faults", std::to_string(one.errors)},
                     {"period_ms", fmt::format("{:.3f}", one.period_s * 1e3)},
                     {"longest_call_ms", fmt::format("{:.3f}", one.longest_call_s * 1e3)}};
  }
  return all;
}

Ros2Status proof_status(std::string_view agent, std::span<const VerifiedProperty> verdicts) {
  Ros2Status status;
  status.path = fmt::format("{}.proved properties", agent);
  std::size_t proved = 0;
  for (const VerifiedProperty& one : verdicts) {
    const bool holds = one.verdict == holds_verdict;
    proved += holds ? 1 : 0;
    if (!holds) worsen(status, Ros2Status::Level::warn, fmt::format("{}: {}", one.name, one.verdict));
    status.values.emplace_back(
        one.name, holds ? fmt::format("holds (proved by {})", one.method) : std::string(one.verdict));
  }
  if (verdicts.empty())
    worsen(status, Ros2Status::Level::warn, "not verified");
  else if (proved == verdicts.size())
    status.message = fmt::format("{} of {} hold", proved, verdicts.size());
  return status;
}

std::unique_ptr<ShownInRos2> ShownInRos2::of(Assembly& assembly, const Clock& clock) {
  const std::optional<std::filesystem::path> folder = ros2_folder_in_use();
  if (!folder) return nullptr;
  std::unique_ptr<ShownInRos2> shown(new ShownInRos2(assembly, clock));
  std::string error;
  try {
    const auto make = reinterpret_cast<Ros2NodesMaker>(ros2_function({*folder}, ros2_nodes_function));
    shown->nodes_ = make(*shown, error);
  } catch (const DriverError& problem) {
    error = problem.what();
  }
  if (!error.empty())
    console::print(LogLevel::warning, clock.now(), "tessera",
                   fmt::format("ROS 2 sees no parameters and diagnostics of this run: {}", error));
  return shown->nodes_ == nullptr ? nullptr : std::move(shown);
}

std::vector<Ros2Parameter> ShownInRos2::parameters() const {
  return ros2_parameters(assembly_.changes->owners(), assembly_.changes->offered());
}

std::optional<std::string> ShownInRos2::set(std::span<const Change> changes) {
  std::optional<Problem> wrong = assembly_.changes->ask_all(changes);
  return wrong ? std::optional(std::move(wrong->text)) : std::nullopt;
}

std::vector<Ros2Status> ShownInRos2::statuses() {
  std::vector<Ros2Status> all = statuses_.of(take_snapshot(assembly_, clock_));
  for (const AgentSpan& agent : agents_of(assembly_.system))
    all.push_back(proof_status(agent.name, assembly_.system.verdicts));
  return all;
}

}  // namespace tessera
