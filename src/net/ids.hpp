#pragma once

#include "tessera/ids.hpp"

/// Numbers of the elements of a net, one type for each kind of element.
namespace tessera::net {

using tessera::Id;
using PlaceId = Id<struct PlaceTag>;            ///< a place of a flat net
using TransitionId = Id<struct TransitionTag>;  ///< a transition of a flat net
using PageId = Id<struct PageTag>;              ///< a page (one net) of a hierarchical net
using FusionId = Id<struct FusionTag>;          ///< a fusion set of a hierarchical net

using tessera::AgentId;               ///< into Parts::agents and Model::agents
using SubsystemId = InstanceId;       ///< into Parts::subsystems and Model::instances
using tessera::BehaviourId;           ///< into Parts::Subsystem::behaviours and spec::Subsystem::behaviours
using tessera::ChannelId;             ///< into Parts::channels and Model::channels
using BlockId = Id<struct BlockTag>;  ///< into Parts::blocks
using FactId = Id<struct FactTag>;    ///< into Parts::facts

}  // namespace tessera::net
