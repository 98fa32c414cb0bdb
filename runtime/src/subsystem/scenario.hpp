#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nets/flat_net.hpp"
#include "nets/plan.hpp"
#include "tessera/tables.hpp"

namespace tessera {

/// A run of the net that a controller is made to follow under the simulated clock: which subsystem fires
/// what, in which order. The layers above are not part of it, they follow by themselves.
struct Scenario {
  /// "None of its initial conditions holds", an outcome without a transition.
  static constexpr std::uint32_t none_holds = Plan::none;
  struct Step {
    std::uint32_t instance;
    std::uint32_t transition;  ///< into the table of its subsystem, or none_holds
    std::string name;
  };
  std::vector<Step> steps;

  /// What an instance has to do, in order.
  [[nodiscard]] std::vector<std::uint32_t> of_instance(std::uint32_t instance) const;
};

/// Reads what `tessera verify --scenario` writes. nullopt and `error`: not readable, or of another net.
[[nodiscard]] std::optional<Scenario> read_scenario(const std::string& file, const System& system,
                                                    const FlatNet& net, std::string& error);

}  // namespace tessera
