#pragma once

#include <compare>
#include <cstdint>

/// Numbers of the elements of a net, one type for each kind of element.
namespace tessera::net {

/// The number of an element, counted from 0. Numbers of different kinds do not mix. A default one is none.
template <class Tag>
struct Id {
  std::uint32_t value = UINT32_MAX;
  auto operator<=>(const Id&) const = default;
  [[nodiscard]] constexpr bool valid() const { return value != UINT32_MAX; }
};
using PlaceId = Id<struct PlaceTag>;            ///< a place of a flat net
using TransitionId = Id<struct TransitionTag>;  ///< a transition of a flat net
using PageId = Id<struct PageTag>;              ///< a page (one net) of a hierarchical net
using FusionId = Id<struct FusionTag>;          ///< a fusion set of a hierarchical net

using AgentId = Id<struct AgentTag>;          ///< into Parts::agents and Model::agents
using SubsystemId = Id<struct SubsystemTag>;  ///< into Parts::subsystems and Model::instances
using BehaviourId = Id<struct BehaviourTag>;  ///< of one subsystem: into Parts::Subsystem::behaviours
using ChannelId = Id<struct ChannelTag>;      ///< into Parts::channels and Model::channels
using BlockId = Id<struct BlockTag>;          ///< into Parts::blocks

}  // namespace tessera::net
