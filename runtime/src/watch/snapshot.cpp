#include "watch/snapshot.hpp"

#include <limits.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "assembly/network_assembly.hpp"

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
  shown.slow_calls = load(gauges.slow_calls);
  shown.late_wakeups = load(gauges.late_wakeups);
  shown.latest_wakeup_s = seconds_of(load(gauges.latest_wakeup_ns));
  if (called) shown.behaviour = tables.net->behaviours[load(gauges.behaviour)].name;
  if (executor.memory() != nullptr) shown.memory = executor.memory()->read();
  return shown;
}

[[nodiscard]] Snapshot::Channel show(const Channel& channel, std::uint16_t marking) {
  Snapshot::Channel shown{.name = std::string(channel.name), .marked = {}, .sending_since_s = {}};
  for (std::size_t place = 0; place < channel.places.size(); ++place)
    if ((marking >> place & 1U) != 0) shown.marked.emplace_back(channel.places[place].name);
  return shown;
}

[[nodiscard]] std::string path_of(const Instance& instance) {
  return std::string(instance.agent) + "." + std::string(instance.name);
}

/// The waits at the two sides of the channels, as far as they are in this process.
class Waits {
 public:
  Waits(const Assembly& assembly, Snapshot& snapshot) : assembly_(assembly), snapshot_(snapshot) {}

  void look(std::uint32_t instance) {
    for (const PortLink& port : assembly_.executors[instance]->operations().parts().ports) {
      if (port.channel == nullptr) continue;
      if (port.end != nullptr && port.side == Side::send && port.end->sending_since_ns() >= 0)
        sending_[port.channel] = port.end->sending_since_ns();
      if (port.channel->waiting(port.side) == SharedChannel::Waiting::in_vain)
        waiting_[port.channel].push_back({instance, port.side});
    }
  }

  void show(std::size_t index) {
    const Assembly::Words& words = assembly_.channels[index];
    for (const SharedChannel* word : {words.of_sender.get(), words.of_receiver.get()}) {
      if (word == nullptr) continue;
      if (const auto found = sending_.find(word); found != sending_.end())
        snapshot_.channels[index].sending_since_s = seconds_of(found->second);
      if (const auto found = waiting_.find(word); found != waiting_.end())
        for (const Waiting& one : found->second) add(index, one);
    }
  }

 private:
  struct Waiting {
    std::uint32_t instance;
    Side side;
  };
  void add(std::size_t index, const Waiting& waiting) {
    const ProcessPart& part = assembly_.part;
    const Channel& channel = part.original(static_cast<std::uint32_t>(index));
    const bool sends = waiting.side == Side::send;
    const std::uint32_t other = (sends ? channel.to : channel.from).instance;
    const SubsystemExecutor& executor = *assembly_.executors[waiting.instance];
    const std::int64_t since = executor.gauges().waits_since_ns.load(std::memory_order_relaxed);
    snapshot_.waits.push_back(
        {.subsystem = executor.path(),
         .waits_for = path_of(part.whole->instances[other]),
         .channel = std::string(channel.name),
         .for_answer = sends,
         .process = part.has(other) ? std::string()
                                    : std::string(part.whole->processes[part.whole->process_of[other]].name),
         .since_s = seconds_of(std::max<std::int64_t>(since, 0))});
  }

  const Assembly& assembly_;
  Snapshot& snapshot_;
  std::unordered_map<const SharedChannel*, std::int64_t> sending_;
  std::unordered_map<const SharedChannel*, std::vector<Waiting>> waiting_;
};

[[nodiscard]] Snapshot::Link show(const LinkGauges& link, const Process& peer) {
  const auto load = [](const auto& value) { return value.load(std::memory_order_relaxed); };
  Snapshot::Link shown;
  shown.process = peer.name;
  shown.host = peer.host;
  shown.reachable = load(link.reachable);
  shown.since_s = seconds_of(load(link.since_ns));
  if (const std::int64_t heard = load(link.heard_ns); heard >= 0) shown.heard_s = seconds_of(heard);
  shown.sent = load(link.sent);
  shown.repeated = load(link.repeated);
  shown.received = load(link.received);
  shown.duplicates = load(link.duplicates);
  shown.signs = load(link.signs_expected);
  shown.signs_lost = load(link.signs_lost);
  if (const std::int64_t uncertainty = load(link.clock_uncertainty_ns); uncertainty >= 0) {
    shown.clock_ahead_s = seconds_of(load(link.clock_ahead_ns));
    shown.clock_uncertainty_s = seconds_of(uncertainty);
  }
  return shown;
}

[[nodiscard]] std::string name_of_machine() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

void show_process(const Assembly& assembly, Snapshot& snapshot) {
  const ProcessPart& part = assembly.part;
  if (!part.process) return;
  const Process& own = part.whole->processes[*part.process];
  snapshot.process = own.name;
  snapshot.host = own.host.empty() ? name_of_machine() : std::string(own.host);
  snapshot.incarnation = std::to_string(assembly.incarnation.value);
  if (assembly.links == nullptr) return;
  for (const auto& link : assembly.links->gauges())
    snapshot.links.push_back(show(*link, part.whole->processes[link->peer]));
}

}  // namespace

std::optional<Snapshot::Deployment> deployment_of(const Assembly& assembly) {
  if (!assembly.part.process || assembly.carrier == nullptr) return std::nullopt;
  const NetworkPlace place = place_of(assembly);
  Snapshot::Deployment deployment{.domain = place.domain,
                                  .interface = std::string(place.interface),
                                  .peers = {place.peers.begin(), place.peers.end()},
                                  .processes = {}};
  for (const Process& one : assembly.part.whole->processes)
    deployment.processes.push_back({std::string(one.name), std::string(one.host)});
  return deployment;
}

Snapshot take_snapshot(const Assembly& assembly, const Clock& clock) {
  Snapshot snapshot;
  snapshot.system = assembly.system.name;
  snapshot.pid = getpid();
  snapshot.net_hash = assembly.system.net_hash;
  for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance)
    snapshot.subsystems.push_back(show(assembly, instance));
  for (std::size_t index = 0; index < assembly.channels.size(); ++index)
    snapshot.channels.push_back(show(assembly.system.channels[index], assembly.channels[index].marking()));
  Waits waits(assembly, snapshot);
  for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance) waits.look(instance);
  for (std::size_t index = 0; index < assembly.channels.size(); ++index) waits.show(index);
  show_process(assembly, snapshot);
  snapshot.time_s = seconds_of(clock.now().time_since_epoch().count());
  if (assembly.control.emergency()) snapshot.emergency = assembly.control.emergency_reason();
  return snapshot;
}

}  // namespace tessera
