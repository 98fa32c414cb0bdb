#include "reduce/fleet_nets.hpp"

#include <stdexcept>

#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"

namespace tessera::test {

net::Net fleet_net(const Fleet& fleet) {
  diagnostics::Diagnostics out("fleet.yaml", fleet_spec(fleet));
  const auto model = spec::parse(out);
  const auto pages = model ? layers::build(*model, out) : std::nullopt;
  auto net = pages ? net::flatten(*pages, out) : std::nullopt;
  if (!net) throw std::runtime_error(diagnostics::render(out));
  return std::move(*net);
}

std::vector<std::vector<net::TransitionId>> per_subsystem(const net::Net& net) {
  std::vector<std::vector<net::TransitionId>> sets;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::SubsystemId subsystem = net.transitions()[index].subsystem;
    if (!subsystem.valid()) continue;
    if (sets.size() <= subsystem.value) sets.resize(subsystem.value + 1);
    sets[subsystem.value].push_back({index});
  }
  return sets;
}

}  // namespace tessera::test
