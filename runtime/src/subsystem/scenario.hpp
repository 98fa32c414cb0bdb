#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nets/flat_net.hpp"
#include "nets/plan.hpp"
#include "tessera/tables.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// A call in a run that shows how old a command can be (tessera verify --explain CHAIN).
struct ForcedCall {
  Duration takes{};
  Duration late{};         ///< from its release until it begins
  std::int32_t order = 0;  ///< of those that can act at one instant, the smaller one goes first
};
struct ForcedTimes {
  Time end{};  ///< of the command
  std::vector<std::vector<ForcedCall>>
      calls;                         ///< per instance, in their order; later ones are drawn as usual
  std::vector<std::uint32_t> place;  ///< per instance: the smaller one goes first among equals
};

/// A run of the net that a controller follows under the simulated clock: which subsystem fires which
/// transition, in which order. The upper layers are not part of it; they follow by themselves.
struct Scenario {
  /// Transitions of one subsystem, into its table; nullopt: no condition of `next` holds.
  using Script = std::vector<std::optional<std::uint32_t>>;
  struct Step {
    std::uint32_t instance;
    std::optional<std::uint32_t> transition;  ///< into the table of its subsystem; nullopt: no `next` holds
    std::string name;
  };
  std::vector<Step> steps;

  std::optional<ForcedTimes> times{};  ///< then there are no steps, and the run ends with the command

  /// The transitions that an instance has to fire, in order.
  [[nodiscard]] Script of_instance(std::uint32_t instance) const;
};

/// Reads the output of `tessera verify --scenario`. nullopt and `error`: unreadable, or for another net.
[[nodiscard]] std::optional<Scenario> read_scenario(const std::string& file, const System& system,
                                                    const FlatNet& net, std::string& error);

}  // namespace tessera
