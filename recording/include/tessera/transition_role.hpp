#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tessera/net_roles.hpp"

namespace tessera {

/// The role of a transition of a run.
struct TransitionRole {
  Step step = Step::other;
  std::string behaviour{};                 ///< the behaviour that it belongs to, or leaves; empty: none
  std::optional<std::uint32_t> channel{};  ///< of a block or a medium: into Recording::channels

  [[nodiscard]] bool ends_iteration() const { return tessera::ends_iteration(step); }
  /// Whether it belongs to the communication of a behaviour.
  [[nodiscard]] bool communicates() const { return step >= Step::page && step <= Step::timeout; }
};

}  // namespace tessera
