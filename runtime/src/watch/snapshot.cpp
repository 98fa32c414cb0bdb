#include "watch/snapshot.hpp"

#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace tessera {
namespace {

[[nodiscard]] double seconds_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

[[nodiscard]] Snapshot::Subsystem show(const Assembly& assembly, std::uint32_t instance) {
  const SubsystemExecutor& executor = *assembly.executors[instance];
  const Gauges& gauges = executor.gauges();
  const Instance& tables = assembly.system.instances[instance];
  const auto load = [](const auto& value) { return value.load(std::memory_order_relaxed); };
  Snapshot::Subsystem shown;
  const bool called = load(gauges.called_at_ns) >= 0;
  shown.path = executor.path();
  shown.calling = load(gauges.calling);
  shown.ended = assembly.control.has_ended(instance);
  shown.iterations = load(gauges.iterations);
  shown.firings = load(gauges.firings);
  shown.overruns = load(gauges.overruns);
  shown.errors = load(gauges.errors);
  shown.period_s = seconds_of(tables.period.count());
  shown.called_at_s = seconds_of(load(gauges.called_at_ns));
  shown.call_s = seconds_of(load(gauges.call_ns));
  shown.longest_call_s = seconds_of(load(gauges.longest_call_ns));
  if (called) shown.behaviour = tables.net->behaviours[load(gauges.behaviour)].name;
  return shown;
}

[[nodiscard]] Snapshot::Channel show(const Channel& channel, std::uint16_t marking) {
  Snapshot::Channel shown{.name = std::string(channel.name), .marked = {}};
  for (std::size_t place = 0; place < channel.places.size(); ++place)
    if ((marking >> place & 1U) != 0) shown.marked.emplace_back(channel.places[place].name);
  return shown;
}

}  // namespace

Snapshot take_snapshot(const Assembly& assembly, const Clock& clock) {
  Snapshot snapshot;
  snapshot.system = assembly.system.name;
  snapshot.pid = getpid();
  snapshot.net_hash = assembly.system.net_hash;
  for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance)
    snapshot.subsystems.push_back(show(assembly, instance));
  for (std::size_t index = 0; index < assembly.channels.size(); ++index)
    snapshot.channels.push_back(show(assembly.system.channels[index], assembly.channels[index].marking()));
  snapshot.time_s = seconds_of(clock.now().time_since_epoch().count());
  if (assembly.control.emergency()) snapshot.emergency = assembly.control.emergency_reason();
  return snapshot;
}

}  // namespace tessera
