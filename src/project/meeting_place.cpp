#include "project/meeting_place.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

#include "tessera/channel_limits.hpp"

namespace tessera::project {

namespace {

std::string interface_of(const spec::Deployment& deployment, const std::string& machine) {
  for (const spec::Process& one : deployment.processes)
    if (!one.interface.empty() && !one.host.empty() && is_this_machine(one.host, machine))
      return one.interface;
  const std::string& first = deployment.processes.front().interface;
  const bool all = std::ranges::all_of(deployment.processes,
                                       [&](const spec::Process& one) { return one.interface == first; });
  return all ? first : "";
}

}  // namespace

std::uint32_t domain_of(const spec::Deployment& deployment, const NetworkOptions& options) {
  if (options.domain.empty()) return deployment.domain;
  std::uint32_t domain = 0;
  const char* const end = options.domain.data() + options.domain.size();
  const auto [behind, problem] = std::from_chars(options.domain.data(), end, domain);
  if (problem == std::errc{} && behind == end && domain <= last_domain) return domain;
  throw std::runtime_error(
      fmt::format("--domain {}: expected a whole number from 0 to {}", options.domain, last_domain));
}

Snapshot::Deployment meeting_place(const spec::Deployment& deployment, const NetworkOptions& options,
                                   const std::string& machine) {
  Snapshot::Deployment place{.domain = static_cast<int>(domain_of(deployment, options)),
                             .interface = options.interface,
                             .peers = names_between_commas(options.peers),
                             .processes = {}};
  if (place.interface.empty()) place.interface = interface_of(deployment, machine);
  for (const spec::Process& one : deployment.processes) {
    place.processes.push_back({one.name, one.host});
    const bool is_new = std::ranges::find(place.peers, one.host) == place.peers.end();
    if (options.peers.empty() && !one.host.empty() && is_new) place.peers.push_back(one.host);
  }
  return place;
}

}  // namespace tessera::project
