#pragma once

#include "tessera/ids.hpp"

/// Numbers of the elements of a specification, one type for each kind of element. A default one is none.
namespace tessera::spec {

using tessera::AgentId;                                         ///< into Model::agents
using tessera::BehaviourId;                                     ///< into Subsystem::behaviours
using tessera::ChannelId;                                       ///< into Model::channels
using tessera::InstanceId;                                      ///< into Model::instances
using tessera::ProcessId;                                       ///< into Deployment::processes
using BufferId = Id<struct BufferTag>;                          ///< into Subsystem::inputs or ::outputs
using CommunicationModelId = Id<struct CommunicationModelTag>;  ///< into Model::models
using DefinedSubsystemId = Id<struct DefinedSubsystemTag>;      ///< into Definition::subsystems
using DefinitionId = Id<struct DefinitionTag>;                  ///< into Model::definitions
using ExpressionId = Id<struct ExpressionTag>;                  ///< into Condition::expressions
using FleetId = Id<struct FleetTag>;                            ///< of the agents of one `count`
using NextId = Id<struct NextTag>;                              ///< into Behaviour::next
using RealId = Id<struct RealTag>;                              ///< into Subsystem::real
using StructureId = Id<struct StructureTag>;                    ///< into Model::structures

}  // namespace tessera::spec
