#include "run/execute.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assembly/assembly.hpp"
#include "assembly/open_devices.hpp"
#include "assembly/planted_faults.hpp"
#include "assembly/ros2_arguments.hpp"
#include "assembly/run_accounts.hpp"
#include "assembly/upper_layers.hpp"
#include "drivers/devices.hpp"
#include "drivers/driver_watch.hpp"
#include "links/incarnation.hpp"
#include "run/process_lives.hpp"
#include "run/simulated_run.hpp"
#include "run/steady_run.hpp"
#include "run/world_checks.hpp"
#include "safety/companions.hpp"
#include "safety/device_claims.hpp"
#include "safety/last_chance.hpp"
#include "safety/protection.hpp"
#include "system/console.hpp"
#include "system/stop_signals.hpp"
#include "tessera/controller.hpp"
#include "tessera/process_claim.hpp"
#include "watch/stuck.hpp"

namespace tessera {
namespace {

void warn(RunSummary& summary, std::string text) {
  console::print(LogLevel::warning, Time(summary.simulated), "tessera", text);
  summary.warnings.push_back(std::move(text));
}

void warn_of_faults_that_never_happened(const Assembly& assembly, Time end, RunSummary& summary) {
  summary.injected = happened(assembly.faults, end);
  for (const RunSummary::PlantedFault& fault : summary.injected)
    if (!fault.happened)
      warn(summary, fmt::format("the planted fault {} never happened; this run does not show what it does",
                                fault.text));
}

void close_recording(Assembly& assembly, RunSummary& summary) {
  if (assembly.recorder == nullptr) return;
  const Recorder::Result result = assembly.recorder->close();
  summary.lost_events = result.lost;
  if (result.kept_from_ns) {
    summary.recorded_from = Duration(*result.kept_from_ns);
    warn(summary, fmt::format("the recording begins at {:.3f} s: what was before is beyond its limit "
                              "(--record-limit none keeps everything)",
                              seconds(*summary.recorded_from)));
  }
  if (result.failure)
    warn(summary,
         fmt::format("the recording '{}' is cut: {}", assembly.options.recording, result.failure->text));
  else if (result.lost > 0)
    warn(summary, fmt::format("{} events are missing in the recording: the disk was too slow", result.lost));
}

void close_world(Assembly& assembly, RunSummary& summary) {
  if (assembly.world == nullptr) return;
  std::string error;
  if (assembly.world->finish(error) || summary.ended.find(error) != std::string::npos) return;
  if (!std::exchange(summary.failed, true)) summary.failure = RunSummary::Failure::world;
  warn(summary, fmt::format("the world: {}", error));
}

[[nodiscard]] std::vector<std::string> devices_left_unsafe(const Assembly& assembly) {
  std::vector<std::string> names;
  for (const auto& executor : assembly.executors)
    std::ranges::move(executor->effectors().unsafe(), std::back_inserter(names));
  return names;
}

/// Makes it a failure, whatever ended the run, if the guardian had to act or could not have acted. Call it
/// when the guardian can do nothing more.
void judge_guardian(const Guardian& guardian, Ending& ending) {
  const std::string_view trouble = Guardian::describe(guardian.trouble());
  if (trouble.empty()) return;
  ending.failed = true;
  if (ending.text.find(trouble) == std::string::npos) ending.text += fmt::format("; {}", trouble);
}

void warn_of_unprotected(const std::vector<std::string>& devices) {
  if (devices.empty()) return;
  console::print(LogLevel::warning, Time{}, "tessera",
                 fmt::format("if the controller is killed, nothing gives the safe command to {} "
                             "(docs/reference/safety.md)",
                             listed_devices(devices)));
}

/// The facts about a run that are known when a driver does not return.
struct KnownRun {
  Assembly* assembly = nullptr;         ///< while it can be used
  OpenDevices* devices = nullptr;       ///< while some may be open
  std::optional<RunSummary> summary{};  ///< the run has ended
  std::string error;                    ///< why it could not start

  [[nodiscard]] Time time() const { return summary ? Time(summary->simulated) : Time{}; }
};

/// what: the driver that does not return. Closes the other devices, and ends the recording. No device needs
/// its safe command: it has got that, or nothing at all.
void end_without_driver(const KnownRun& known, const GiveUp& give_up, const std::string& what) {
  RunSummary summary = known.summary.value_or(RunSummary{});
  if (known.devices != nullptr) known.devices->close_what_can_be_closed({});
  if (!known.summary) summary.ended = known.error;
  if (const int signal = StopSignals::pending(); summary.ended.empty() && signal != 0)
    summary.ended = StopSignals::name(signal);
  summary.ended += (summary.ended.empty() ? "" : "; ") + what;
  summary.failed = true;
  console::print(LogLevel::error, known.time(), "tessera", known.summary ? what : summary.ended);
  if (!known.summary && known.assembly != nullptr) {
    if (RecordingLane* const lane = known.assembly->system_lane(); lane != nullptr)
      lane->text(Event::Kind::stop, known.time(), 1, summary.ended);
    close_recording(*known.assembly, summary);
    if (known.assembly->guardian != nullptr) known.assembly->guardian->dismiss();
  }
  give_up.end_process(summary);
}

/// Call it when the run and its recording have ended, so that a driver that does not return or crashes costs
/// neither.
void close_the_devices(OpenDevices& devices, const std::vector<bool>& left_behind, RunSummary& summary,
                       KnownRun& known) {
  if (!left_behind.empty()) return devices.close_what_can_be_closed(left_behind);
  known.summary = summary;
  for (const std::string& complaint : devices.close()) warn(summary, complaint);
}

/// Fills in everything except the facts that only the driver of the run knows.
template <class Run>
[[nodiscard]] std::optional<RunSummary> drive(Run& run, Assembly& assembly, const StopSignals& signals,
                                              KnownRun& known) {
  std::string& error = known.error;
  if (!assemble(assembly, run.clock(), run, error)) return std::nullopt;
  if (std::optional<std::string> late = fault_after_end(assembly.faults, assembly.options)) {
    error = *std::move(late);
    return std::nullopt;
  }
  RecordingLane* const lane = assembly.system_lane();
  UpperLayers upper(*assembly.part.whole, agents_of(assembly.system), assembly.part.agents,
                    !assembly.part.process, lane);
  OpenDevices devices(assembly);
  known.devices = &devices;
  if (!devices.open(error)) return std::nullopt;
  std::optional<DeathNote> death_note;
  if (opens_real_devices(assembly.system, assembly.options)) {
    const std::vector<std::string> unprotected = unprotected_devices(assembly);
    death_note.emplace(assembly.options.death_note, unprotected);
    warn_of_unprotected(unprotected);
  }
  std::optional<LastChance> last_chance;
  last_chance.emplace(assembly, run.clock(), assembly.guardian);
  const std::int64_t start_ns = monotonic_ns();
  Ending ending = [&] {
    const DriverWatch::Unwatched others_watch;
    return run.run(assembly, upper, signals);
  }();
  const std::vector<std::string> unsafe = devices_left_unsafe(assembly);
  last_chance.reset();
  if (assembly.guardian != nullptr) {
    if (unsafe.empty()) assembly.guardian->dismiss();
    judge_guardian(*assembly.guardian, ending);
  }
  if (!unsafe.empty()) {
    if (!std::exchange(ending.failed, true)) ending.failure = RunSummary::Failure::unsafe;
    if (const std::string text = not_safe(unsafe); ending.text.find(text) == std::string::npos)
      ending.text += "; " + text;
  }
  std::string stuck;
  if (!ending.failed) stuck = stuck_text(assembly, stuck_for_good(assembly));
  if (!stuck.empty() && !assembly.options.accept_stuck) {
    ending.text += "; " + std::exchange(stuck, {});
    ending.failed = true;
    ending.failure = RunSummary::Failure::stuck;
  }
  if (const std::optional<std::string> failed_checks = finish_checks(assembly, ending.at)) {
    ending.text += *failed_checks;
    if (!std::exchange(ending.failed, true)) ending.failure = RunSummary::Failure::check;
  }

  RunSummary summary;
  summary.simulated = ending.at.time_since_epoch();
  summary.wall_s = static_cast<double>(monotonic_ns() - start_ns) * 1e-9;
  summary.failed = ending.failed;
  summary.failure = ending.failure;
  summary.signal = ending.signal;
  summary.world_time = ending.world_time;
  summary.judgement = std::exchange(assembly.judgement, {});
  summary.used = used_resources(assembly, ending.at);
  summary.firings = upper.firings() + ProcessLives::past_firings(assembly);
  for (const auto& executor : assembly.executors) {
    const Operations& operations = executor->operations();
    summary.firings += executor->firings();
    const Overtimes& times = operations.overtimes();
    summary.subsystems.push_back({executor->path(), operations.iterations(), executor->overruns(),
                                  operations.errors(), times.slow_calls(), times.late_wakeups(),
                                  times.latest_wakeup()});
  }
  summary.overtime = slow_calls(assembly);
  summary.chains = assembly.chains.times();
  for (const std::string& device : unsafe)
    if (lane != nullptr)
      lane->text(Event::Kind::safe, ending.at, static_cast<std::uint32_t>(SafeEvent::refused),
                 fmt::format("{}: has not taken its safe command", device));
  if (ending.world_time)
    warn(summary, fmt::format("the simulated world ran at {:.2f} of real time: {:.3f} s of {:.3f} s",
                              seconds(*ending.world_time) / seconds(summary.simulated),
                              seconds(*ending.world_time), seconds(summary.simulated)));
  if (lane != nullptr) lane->text(Event::Kind::stop, ending.at, ending.failed ? 1 : 0, ending.text);
  if (ending.failed) console::print(LogLevel::error, ending.at, "tessera", ending.text);
  summary.ended = std::move(ending.text);
  if (!stuck.empty()) warn(summary, stuck);
  warn_of_faults_that_never_happened(assembly, ending.at, summary);
  close_recording(assembly, summary);
  close_the_devices(devices, ending.left_behind, summary, known);
  close_world(assembly, summary);
  known.summary = summary;
  return summary;
}

/// The same. From its return on, drivers can only be destroyed. error: why the run could not start.
template <class Run>
[[nodiscard]] std::optional<RunSummary> drive_known(Run& run, Assembly& assembly, const StopSignals& signals,
                                                    KnownRun& known, std::string& error) {
  known.assembly = &assembly;
  std::optional<RunSummary> summary = drive(run, assembly, signals, known);
  known.assembly = nullptr;
  known.devices = nullptr;
  if (!summary) error = known.error;
  return summary;
}

[[nodiscard]] std::optional<RunSummary> with_lost_lines(std::optional<RunSummary> summary,
                                                        const Assembly& assembly, console::Session& session) {
  if (!summary && assembly.guardian != nullptr) assembly.guardian->dismiss();  // the run has not started
  if (summary) summary->lines_not_printed = session.settle();
  return summary;
}

}  // namespace

namespace {

/// Greater than that of every earlier start, unless the clock of the machine was set back.
[[nodiscard]] network::Incarnation incarnation_of(const RunOptions& options) {
  if (options.network.process.empty()) return {1};
  if (options.network.incarnation) return {*options.network.incarnation};
  return new_incarnation(options.recording, options.network.process);
}

/// The options without the devices of other processes.
[[nodiscard]] RunOptions options_of(const ProcessPart& part, RunOptions options) {
  if (!part.process) return options;
  const auto agents = agents_of(part.system);
  std::erase_if(options.drivers, [&](const DriverRequest& driver) {
    return std::ranges::find(agents, driver.path.substr(0, driver.path.find('.')), &AgentSpan::name) ==
           agents.end();
  });
  return options;
}

[[nodiscard]] ClaimedProcess claimed(const ProcessPart& part, const RunOptions& options) {
  const RunOptions::Network& given = options.network;
  const Process& process = part.whole->processes[*part.process];
  return {.system = std::string(part.whole->name),
          .process = std::string(process.name),
          .domain = given.domain.value_or(static_cast<int>(part.whole->domain)),
          .interface = given.interface.empty() ? std::string(process.interface) : given.interface};
}

[[nodiscard]] std::string names_of(std::span<const Process> processes) {
  std::string names;
  for (const Process& process : processes) names += (names.empty() ? "" : ", ") + std::string(process.name);
  return names;
}

/// nullopt and `error`: the options do not say which process to run.
[[nodiscard]] std::optional<ProcessPart> part_to_run(const System& system, const RunOptions& options,
                                                     std::string& error) {
  const std::string& process = options.network.process;
  if (options.clock == RunOptions::Clock::simulated) {
    if (process.empty()) return all_of(system);
    error = "the simulated clock runs all processes at once; --process is for real time";
    return std::nullopt;
  }
  if (process.empty() && system.processes.size() < 2) return all_of(system);
  if (process.empty()) {
    error = fmt::format("{} is deployed in {} processes; say which one runs here: --process NAME ({})",
                        system.name, system.processes.size(), names_of(system.processes));
    return std::nullopt;
  }
  std::optional<ProcessPart> part = part_of(system, process);
  if (!part)
    error = system.processes.empty()
                ? fmt::format("{} is not deployed in processes, so there is no process '{}'", system.name,
                              process)
                : fmt::format("{} has no process '{}'; there are {}", system.name, process,
                              names_of(system.processes));
  return part;
}

}  // namespace

std::optional<RunSummary> execute(const System& system, const RunOptions& options, std::string& error) {
  return execute(system, options, nullptr, {}, error);
}

std::optional<RunSummary> execute(const System& system, const RunOptions& given, RunTally* tally,
                                  const GiveUp& give_up, std::string& error) {
  std::optional<ProcessPart> part = part_to_run(system, given, error);
  if (!part) return std::nullopt;
  RunOptions options = options_of(*part, given);
  Ros2ArgumentNotes ros2;
  if (!take_ros2_arguments(*part, options, ros2, error)) return std::nullopt;
  const auto instances = static_cast<std::uint32_t>(part->system.instances.size());
  const bool simulated = options.clock == RunOptions::Clock::simulated;
  const bool nothing_real = simulated && options.hardware.empty();
  if (options.orders >= 0 && (simulated || part->process)) {
    error = simulated ? "the simulated clock cannot be held by another process"
                      : "a process of a deployment cannot be held: the others would wait for it";
    return std::nullopt;
  }
  // In force from before the first driver is made until the last is gone. Only the steady clock can be
  // suspended.
  using Suspension = StopSignals::Suspension;
  const StopSignals signals(nothing_real ? Suspension::usual
                            : simulated  ? Suspension::ends_run
                                         : Suspension::noted);
  // Must run before there are threads.
  Companions companions(part->system, options);
  if (!companions.start_guardian(error)) return std::nullopt;
  // Made after the guardian, which would inherit it.
  std::optional<ProcessClaim> claim;
  if (part->process) claim.emplace(claimed(*part, options));
  const auto refuse = [&](std::string why) {
    if (companions.guardian() != nullptr) companions.guardian()->dismiss();
    error = std::move(why);
    return std::nullopt;
  };
  if (claim && claim->other()) return refuse(runs_already(claimed(*part, options), *claim->other()));
  const DeviceClaims device_claims(part->system, options);
  if (device_claims.refusal()) return refuse(*device_claims.refusal());
  // No real device waits for a slow reader of the output.
  using Overflow = console::Session::Overflow;
  console::Session session(nothing_real ? Overflow::waits : Overflow::loses);
  for (const std::string& note : ros2.notes) console::print(LogLevel::info, Time{}, "tessera", note);
  for (const std::string& warning : ros2.warnings)
    console::print(LogLevel::warning, Time{}, "tessera", warning);
  companions.watch_parent();
  KnownRun known;
  std::optional<DriverWatch> driver_watch;
  if (give_up.end_process)
    driver_watch.emplace(
        give_up.unsafe,
        [&](const std::string& text) { console::print(LogLevel::warning, known.time(), "tessera", text); },
        [&](const std::string& what) { end_without_driver(known, give_up, what); });
  Assembly assembly(std::move(*part), options);
  assembly.guardian = companions.guardian();
  if (assembly.guardian != nullptr) assembly.control.withhold_after(assembly.guardian->has_acted());
  const std::unique_ptr<ProcessWatch> guardian_watch = companions.watch_guardian(assembly.control);
  assembly.incarnation = incarnation_of(options);
  assembly.tally = tally;
  if (simulated) {
    SimulatedRun run(instances, options.seed);
    try {
      if (!options.ros2_clock.empty()) run.publish_clock(options.ros2_clock);
    } catch (const DriverError& wrong) {
      error = fmt::format("/clock cannot be published: {}", wrong.what());
      return with_lost_lines(std::nullopt, assembly, session);
    }
    return with_lost_lines(drive_known(run, assembly, signals, known, error), assembly, session);
  }
  if (assembly.part.process && options.world)
    console::print(LogLevel::warning, Time{}, "tessera",
                   "this process simulates a world of its own, which no other process sees");
  SteadyRun run(instances, give_up);
  if (const std::optional<Problem> failure = run.listen(assembly))
    return refuse(
        fmt::format("the run could not be stopped from outside, since it has no control socket: {}; "
                    "--no-monitor runs without one",
                    failure->text));
  std::optional<RunSummary> summary =
      with_lost_lines(drive_known(run, assembly, signals, known, error), assembly, session);
  if (run.has_given_up()) give_up.end_process(*summary);
  return summary;
}

}  // namespace tessera
