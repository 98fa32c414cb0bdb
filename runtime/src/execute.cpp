#include <fmt/core.h>

#include <exception>
#include <optional>

#include "assembly.hpp"
#include "console.hpp"
#include "simulated_run.hpp"
#include "steady_run.hpp"
#include "stop_signals.hpp"
#include "tessera/controller.hpp"
#include "upper_layers.hpp"

namespace tessera {
namespace {

void warn(RunSummary& summary, std::string text) {
  console::print(LogLevel::warning, Time(summary.simulated), "tessera", text);
  summary.warnings.push_back(std::move(text));
}

void close_recording(Assembly& assembly, RunSummary& summary) {
  if (assembly.recorder == nullptr) return;
  const Recorder::Result result = assembly.recorder->close();
  summary.lost_events = result.lost;
  if (!result.failure.empty())
    warn(summary, fmt::format("the recording '{}' is cut: {}", assembly.options.recording, result.failure));
  else if (result.lost > 0)
    warn(summary, fmt::format("{} events are missing in the recording: the disk was too slow", result.lost));
}

void close_world(Assembly& assembly, RunSummary& summary) {
  if (assembly.world == nullptr) return;
  std::string error;
  if (assembly.world->finish(error)) return;
  summary.failed = true;
  warn(summary, fmt::format("the world: {}", error));
}

/// Everything but what only the driver of the run knows.
template <class Run>
[[nodiscard]] std::optional<RunSummary> drive(Run& run, Assembly& assembly, std::string& error) {
  if (!assemble(assembly, run.clock(), run, error)) return std::nullopt;
  RecordingLane* lane = assembly.recorder == nullptr ? nullptr : assembly.recorder->system_lane();
  UpperLayers upper(agents_of(assembly.system), lane);
  const StopSignals signals;
  const std::int64_t start_ns = monotonic_ns();
  Ending ending = run.run(assembly, upper, signals);

  RunSummary summary;
  summary.simulated = ending.at.time_since_epoch();
  summary.wall_s = static_cast<double>(monotonic_ns() - start_ns) * 1e-9;
  summary.failed = ending.failed;
  summary.firings = upper.firings();
  for (const auto& executor : assembly.executors) {
    const Operations& operations = executor->operations();
    summary.firings += executor->firings();
    summary.subsystems.push_back(
        {executor->path(), operations.iterations(), executor->overruns(), operations.errors()});
  }
  if (lane != nullptr) lane->text(Event::Kind::stop, ending.at, ending.failed ? 1 : 0, ending.text);
  if (ending.failed) console::print(LogLevel::error, ending.at, "tessera", ending.text);
  summary.ended = std::move(ending.text);
  close_recording(assembly, summary);
  close_world(assembly, summary);
  return summary;
}

}  // namespace

std::optional<RunSummary> execute(const System& system, const RunOptions& options, std::string& error) {
  const auto instances = static_cast<std::uint32_t>(system.instances.size());
  Assembly assembly(system, options);
  if (options.clock == RunOptions::Clock::simulated) {
    SimulatedRun run(instances, options.seed);
    return drive(run, assembly, error);
  }
  SteadyRun run(instances);
  return drive(run, assembly, error);
}

}  // namespace tessera
