// The chains of a model, and the channels along which values go through them.
#pragma once

#include <string>
#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

/// A chain from one device to another, with the ways over channels whose values can be followed: those without a
/// communication model of their own, since its firings do not say which one moves the value.
struct ChainWays {
  std::string name;  ///< as the specification names it; else "robot[3].eye -> robot[3].control -> ..."
  std::vector<InstanceId> path;              ///< at least two
  std::vector<std::vector<ChannelId>> ways;  ///< at least one; each has one channel fewer than the path
};

/// Those that the specification names; else each receptor -> control -> effector of one agent, agent by agent.
/// Chains without a way are left out.
[[nodiscard]] std::vector<ChainWays> chain_ways(const Model& model);

/// "robot[].control": the members of a fleet have one name.
[[nodiscard]] std::string fleet_name_of(const std::string& name);

}  // namespace tessera::spec
