#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/tables.hpp"
#include "tessera/transition_role.hpp"

namespace tessera {

/// The whole flat net of a controller's tables, by names. It is the net that was verified and of which the
/// hash was computed; recordings name its transitions. Execution uses Plan.
struct FlatNet {
  struct FlatPlace {
    std::string name;
    std::uint32_t tokens = 0;
  };
  struct FlatTransition {
    std::string name;
    std::uint32_t instance;                      ///< system_instance: of the upper layers, or of the network
    std::vector<std::uint32_t> inputs, outputs;  ///< into places
    std::string guard;
    TransitionRole role{};  ///< its channel: into System::channels
  };
  std::vector<FlatPlace> places;
  /// Those of the system's page; then, per agent, those of its page; then, per instance, in the order of its
  /// table; then those of the media, per channel.
  std::vector<FlatTransition> transitions;
  std::vector<std::uint32_t> first_of_instance;  ///< into transitions

  [[nodiscard]] std::string hash() const;
};

/// The agents of a system: its instances come agent by agent.
struct AgentSpan {
  std::string_view name;
  std::uint32_t first, end;  ///< instances
};
[[nodiscard]] std::vector<AgentSpan> agents_of(const System& system);

/// The numbers of the transitions above the subsystems, in FlatNet::transitions.
[[nodiscard]] std::uint32_t system_transition(const System& system, Step step);
[[nodiscard]] std::uint32_t agent_transition(const System& system, std::uint32_t agent, Step step);

/// Every number in the tables must exist (Plan checks that). An end of an arc that does not is left out, so
/// that the hash differs.
[[nodiscard]] FlatNet net_of(const System& system);

}  // namespace tessera
