#include "assembly/planted_faults.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

namespace tessera {
namespace {

[[nodiscard]] bool is_of_device(const Injection& fault) {
  return fault.kind == Injection::Kind::device || fault.kind == Injection::Kind::silence;
}

[[nodiscard]] bool is_of_transition_function(const Injection& fault) {
  return fault.kind == Injection::Kind::exception || fault.kind == Injection::Kind::stall ||
         fault.kind == Injection::Kind::number;
}

/// buffer: those of this device; empty: of all parts.
template <class Wanted>
[[nodiscard]] Injections faults_of(const Injections& faults, std::uint32_t instance, std::string_view buffer,
                                   Wanted wanted) {
  Injections found;
  for (const std::shared_ptr<Injection>& fault : faults)
    if (fault->instance == instance && wanted(*fault) &&
        (buffer.empty() || fault->part.empty() || fault->part == buffer))
      found.push_back(fault);
  return found;
}

}  // namespace

bool read_faults(const RunOptions& options, const ProcessPart& part, Injections& faults, std::string& error) {
  for (const std::string& text : options.inject) {
    std::optional<Injection> fault = read_injection(text, *part.whole, options.seed, options.duration, error);
    if (!fault) return false;
    const bool of_process = fault->kind == Injection::Kind::process;
    const bool of_link = fault->kind == Injection::Kind::link || of_process;
    if (of_link && options.clock != RunOptions::Clock::simulated) {
      error = "--inject " + text +
              (of_process ? ": processes die under the simulated clock only; in real time, kill them"
                          : ": links are cut under the simulated clock only");
      return false;
    }
    if (of_process && (options.monitor || !options.hardware.empty())) {
      error = "--inject " + text +
              ": a run in which processes die has no hardware in the loop, and cannot be controlled";
      return false;
    }
    if (!of_link && fault->kind != Injection::Kind::signal) {
      const auto own = std::ranges::find(part.instances, fault->instance);
      if (own == part.instances.end()) continue;
      fault->instance = static_cast<std::uint32_t>(own - part.instances.begin());
    }
    faults.push_back(std::make_shared<Injection>(std::move(*fault)));
  }
  return true;
}

std::optional<std::string> fault_after_end(const Injections& faults, const RunOptions& options) {
  // The duration of a run that follows a scenario begins after the scenario.
  if (!options.duration || !options.scenario.empty()) return std::nullopt;
  const Time end(*options.duration);
  for (const std::shared_ptr<Injection>& fault : faults)
    if (fault->from >= end && !fault->text.ends_with("@any"))
      return fmt::format("--inject {}: the fault would never happen, because the run ends after {:g} s",
                         fault->text, seconds(*options.duration));
  return std::nullopt;
}

std::vector<RunSummary::PlantedFault> happened(const Injections& faults, Time end) {
  std::vector<RunSummary::PlantedFault> all;
  for (const std::shared_ptr<Injection>& fault : faults) {
    const bool by_time = fault->kind == Injection::Kind::link || fault->kind == Injection::Kind::process;
    all.push_back({fault->text, by_time ? fault->from < end : fault->has_happened()});
  }
  return all;
}

std::vector<Cut> cuts_of(const Injections& faults) {
  std::vector<Cut> cuts;
  for (const std::shared_ptr<Injection>& fault : faults)
    if (fault->kind == Injection::Kind::link)
      cuts.push_back(
          {fault->processes.first, fault->processes.second, fault->from, fault->from + fault->delay});
  return cuts;
}

bool outages_of(const Injections& faults, const System& whole, std::vector<Outage>& outages,
                std::string& error) {
  for (const std::shared_ptr<Injection>& fault : faults)
    if (fault->kind == Injection::Kind::process)
      outages.push_back({fault->processes.first, fault->from,
                         fault->delay == Duration::max()
                             ? Time::max()
                             : fault->from + std::max(fault->delay, Duration{1})});
  std::ranges::stable_sort(outages, {}, &Outage::from);
  for (auto one = outages.begin(); one != outages.end(); ++one)
    for (auto other = std::next(one); other != outages.end(); ++other)
      if (one->process == other->process && other->from <= one->until) {
        error = "--inject: " + std::string(whole.processes[one->process].name) +
                " dies twice without having begun again in between";
        return false;
      }
  return true;
}

void plant_subsystem_faults(SubsystemParts& parts, const Injections& faults, const Clock& clock) {
  for (const std::shared_ptr<Injection>& fault : faults)
    if (fault->instance == parts.index && is_of_device(*fault)) fault->context = &parts.subsystem->context();
  Injections own = faults_of(faults, parts.index, "", is_of_transition_function);
  if (own.empty()) return;
  auto faulty = std::make_unique<FaultySubsystem>(std::move(parts.subsystem), *parts.instance->net,
                                                  std::move(own), clock);
  parts.faulty = faulty.get();
  parts.subsystem = std::move(faulty);
}

void plant_device_faults(SubsystemParts& parts, const Injections& faults, const Clock& clock) {
  const auto of = [&](std::string_view buffer) {
    return faults_of(faults, parts.index, buffer, is_of_device);
  };
  for (std::size_t index = 0; index < parts.receptors.size(); ++index)
    parts.receptors[index] =
        with_faults(std::move(parts.receptors[index]), of(parts.bindings.real_inputs[index].name), clock);
  for (std::size_t index = 0; index < parts.effectors.size(); ++index)
    parts.effectors[index] =
        with_faults(std::move(parts.effectors[index]), of(parts.bindings.real_outputs[index].name), clock,
                    parts.bindings.real_outputs[index].safe.get());
}

}  // namespace tessera
