#include "network/dds/deployment.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string_view>

#include "network/dds/setup_error.hpp"

namespace tessera::dds {
namespace {

/// FNV-1a of all names in their order, and of the liveliness: with different ones, the process with the
/// shorter liveliness would lose the other between two signs of life. The hash tells deployments apart; it is
/// no protection against an attacker.
std::string hash_of(std::span<const std::string_view> names, std::chrono::nanoseconds liveliness) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&](unsigned char byte) { hash = (hash ^ byte) * 0x100000001b3U; };
  const auto add_text = [&](std::string_view text) {
    for (const char letter : text) add(static_cast<unsigned char>(letter));
    add(0);
  };
  for (const std::string_view name : names) add_text(name);
  add_text(std::to_string(liveliness.count()));
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash));
  return digits.data();
}

constexpr std::uint32_t longest_value = 1U << 30;

void add_channel(Deployment& deployment, const network::ChannelSetup& setup) {
  const std::string name(setup.name);
  const std::size_t processes = deployment.processes.size();
  if (setup.sender >= processes || setup.receiver >= processes)
    throw SetupError("channel " + name + " begins or ends in a process that does not exist");
  if (setup.sender == setup.receiver) throw SetupError("channel " + name + " is inside one process");
  if (setup.sender != deployment.process && setup.receiver != deployment.process) return;
  if (setup.longest_value_bytes > longest_value)
    throw SetupError("values of channel " + name + " are longer than a message can be (1 GiB)");
  const Channel channel{.name = name,
                        .sender = setup.sender,
                        .receiver = setup.receiver,
                        .longest_value_bytes = setup.longest_value_bytes};
  if (!deployment.channels.emplace(setup.number, channel).second)
    throw SetupError("two channels have the number of " + name);
  deployment.peers.push_back(setup.sender == deployment.process ? setup.receiver : setup.sender);
}

}  // namespace

const Channel* Deployment::channel(ChannelNumber number) const {
  const auto found = channels.find(number);
  return found == channels.end() ? nullptr : &found->second;
}

bool Deployment::sends_to(ProcessNumber peer) const {
  return std::ranges::any_of(channels, [&](const auto& one) { return one.second.receiver == peer; });
}

bool Deployment::receives_from(ProcessNumber peer) const {
  return std::ranges::any_of(channels, [&](const auto& one) { return one.second.sender == peer; });
}

std::uint32_t Deployment::longest_received_bytes() const {
  std::uint32_t longest = 0;
  for (const auto& [number, channel] : channels)
    if (channel.receiver == process) longest = std::max(longest, channel.longest_value_bytes);
  return longest;
}

Deployment deployment_of(const network::CarrierSetup& setup) {
  Deployment deployment;
  if (setup.system.empty() || setup.net_hash.empty()) throw SetupError("the system has no name or no hash");
  if (setup.process >= setup.processes.size()) throw SetupError("this process is not one of the deployment");
  if (setup.incarnation == 0) throw SetupError("the incarnation must be greater than 0");
  if (setup.liveliness <= std::chrono::nanoseconds::zero())
    throw SetupError("the deployment has no liveliness");
  deployment.system = setup.system;
  deployment.net_hash = setup.net_hash;
  deployment.process = setup.process;
  deployment.incarnation = setup.incarnation;
  deployment.liveliness = setup.liveliness;
  deployment.processes.assign(setup.processes.begin(), setup.processes.end());
  deployment.processes_hash = hash_of(setup.processes, setup.liveliness);
  for (const network::ChannelSetup& channel : setup.channels) add_channel(deployment, channel);
  std::ranges::sort(deployment.peers);
  deployment.peers.erase(std::unique(deployment.peers.begin(), deployment.peers.end()),
                         deployment.peers.end());
  return deployment;
}

}  // namespace tessera::dds
