#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "net/net.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {

using Random = std::mt19937;

inline constexpr std::uint32_t upper_layers = system_instance;

/// A random run of the net, recorded as the runtime would under the simulated clock.
inline Recording random_run(const net::Net& net, std::size_t firings, Random& random) {
  Recording recording;
  recording.clock = "simulated";
  std::uint32_t instances = 0;
  for (const net::Transition& transition : net.transitions()) {
    recording.transitions.push_back(
        {transition.name, transition.subsystem.valid() ? transition.subsystem.value : upper_layers});
    if (transition.subsystem.valid()) instances = std::max(instances, transition.subsystem.value + 1);
  }
  for (std::uint32_t index = 0; index < instances; ++index)
    recording.instances.push_back(net.parts().subsystems.empty() ? "s" + std::to_string(index)
                                                                 : net.parts().subsystems[index].path);
  std::vector<std::uint32_t> marking;
  for (const net::Place& place : net.places()) marking.push_back(place.tokens);
  std::map<net::ChannelId, std::uint32_t> versions;
  std::map<std::uint32_t, std::uint32_t> sequences;
  for (std::size_t step = 0; step < firings; ++step) {
    std::vector<std::uint32_t> enabled;
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      if (net.transitions()[index].condition.truth != net::Condition::Truth::never &&
          std::ranges::all_of(net.preset(net::TransitionId{index}),
                              [&](const net::Arc& arc) { return marking[arc.place.value] >= arc.weight; }))
        enabled.push_back(index);
    if (enabled.empty()) break;
    const net::TransitionId id{enabled[random() % enabled.size()]};
    Event event{.time_ns = static_cast<std::int64_t>(step / 3 * 1000), .subject = id.value};
    for (const auto& [arcs, change] : {std::pair(net.preset(id), -1), std::pair(net.postset(id), 1)})
      for (const net::Arc& arc : arcs) {
        marking[arc.place.value] += static_cast<std::uint32_t>(change);
        if (net[arc.place].fused() && event.version == 0) event.version = ++versions[net[arc.place].channel];
      }
    const std::uint32_t instance = net[id].subsystem.valid() ? net[id].subsystem.value : upper_layers;
    event.sequence = sequences[instance]++;
    event.origin = instance << 8 | static_cast<std::uint32_t>(Event::Kind::firing);
    recording.entries.push_back({event, {}});
  }
  return recording;
}

}  // namespace tessera::replay
