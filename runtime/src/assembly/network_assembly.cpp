#include "assembly/network_assembly.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "assembly/planted_faults.hpp"
#include "links/carrier_library.hpp"
#include "system/console.hpp"

namespace tessera {
namespace {

/// The hosts of all processes, each once.
[[nodiscard]] std::vector<std::string_view> hosts_of(const System& whole) {
  std::vector<std::string_view> hosts;
  for (const Process& process : whole.processes)
    if (!process.host.empty() && std::ranges::find(hosts, process.host) == hosts.end())
      hosts.push_back(process.host);
  return hosts;
}

[[nodiscard]] bool open_library(Assembly& assembly, std::string& error) {
  const System& whole = *assembly.part.whole;
  const RunOptions::Network& given = assembly.options.network;
  const std::uint32_t process = *assembly.part.process;
  std::vector<std::string_view> names;
  for (const Process& one : whole.processes) names.push_back(one.name);
  const NetworkPlace place = place_of(assembly);
  const std::vector<network::ChannelSetup> channels = assembly.links->carried();
  const network::CarrierSetup setup{.system = whole.name,
                                    .net_hash = whole.net_hash,
                                    .process = process,
                                    .processes = names,
                                    .incarnation = assembly.incarnation.value,
                                    .liveliness = whole.liveliness,
                                    .domain = place.domain,
                                    .interface = place.interface,
                                    .peers = place.peers,
                                    .channels = channels};
  assembly.carrier = open_carrier(given.library, setup, error);
  if (assembly.carrier == nullptr) return false;
  assembly.links->connect(*assembly.carrier);
  return true;
}

[[nodiscard]] bool simulate(Assembly& assembly, const Clock& clock, std::string& error) {
  const System& whole = *assembly.part.whole;
  NetworkConditions conditions;
  if (const std::string& given = assembly.options.network.conditions; !given.empty()) {
    const std::optional<NetworkConditions> read = read_network(given, error);
    if (!read) return false;
    conditions = *read;
  }
  std::vector<SimulatedNetwork::Channel> channels;
  for (const Channel& channel : whole.channels)
    channels.push_back({whole.process_of[channel.from.instance], whole.process_of[channel.to.instance]});
  assembly.network = std::make_unique<SimulatedNetwork>(
      conditions, cuts_of(assembly.faults), assembly.outages, whole.liveliness, assembly.options.seed, clock,
      std::move(channels),
      [&links = *assembly.links](network::ProcessNumber one, network::ProcessNumber other, bool are) {
        links.joined(one, other, are);
      });
  assembly.links->connect(*assembly.network);
  return true;
}

}  // namespace

NetworkPlace place_of(const Assembly& assembly) {
  const System& whole = *assembly.part.whole;
  const RunOptions::Network& given = assembly.options.network;
  return {
      .domain = given.domain.value_or(static_cast<int>(whole.domain)),
      .interface =
          given.interface.empty() ? whole.processes[*assembly.part.process].interface : std::string_view(given.interface),
      .peers = given.peers.empty() ? hosts_of(whole)
                                   : std::vector<std::string_view>(given.peers.begin(), given.peers.end())};
}

std::uint16_t Assembly::Words::marking() const {
  if (of_receiver == nullptr) return of_sender == nullptr ? std::uint16_t{0} : of_sender->marking();
  const std::uint16_t there = of_receiver->marking();
  return of_sender == nullptr ? there
                              : static_cast<std::uint16_t>((of_sender->marking() & ~receivers) | there);
}

void make_links(Assembly& assembly, const Clock& clock) {
  const ProcessPart& part = assembly.part;
  bool any = false;
  for (std::uint32_t index = 0; index < part.channels.size(); ++index) any = any || part.is_networked(index);
  if (!any) return;
  RunControl& control = assembly.control;
  assembly.links = std::make_unique<Links>(clock, static_cast<std::uint32_t>(part.whole->channels.size()),
                                           [&control, &clock](std::string_view text, bool fatal) {
                                             console::print(fatal ? LogLevel::error : LogLevel::warning,
                                                            clock.now(), "network", text);
                                             if (fatal) control.request_stop(text, /*fault=*/true);
                                           });
}

MadeEnd make_end(Assembly& assembly, const Clock& clock, std::uint32_t index, Side side,
                 const CarriedValue& value, network::Incarnation incarnation) {
  const ProcessPart& part = assembly.part;
  const bool sends = side == Side::send;
  const LinkedChannel linked = linked_channel(*part.whole, part.channels[index], sends);
  const std::uint32_t marking = linked.exchanged ? linked.own_memory
                                : sends          ? linked.idle | linked.empty
                                                 : linked.empty;
  Assembly::Words& words = assembly.channels[index];
  if (!sends) words.receivers = linked.exchanged ? linked.own_memory : linked.empty | linked.full;
  std::unique_ptr<SharedChannel>& word = sends ? words.of_sender : words.of_receiver;
  word = std::make_unique<SharedChannel>(marking, value.bytes, 1, value.type);
  if (clock.simulated()) word->set_single_threaded();
  if (sends) return {word.get(), &assembly.links->add_sender(linked, *word, *value.encoding, incarnation)};
  return {word.get(), &assembly.links->add_receiver(linked, *word, *value.encoding, value.bytes, value.type,
                                                    incarnation)};
}

bool open_network(Assembly& assembly, const Clock& clock, std::string& error) {
  if (assembly.links == nullptr) return true;
  return clock.simulated() ? simulate(assembly, clock, error) : open_library(assembly, error);
}

}  // namespace tessera
