#include "verify/waiting/waiting.hpp"

#include <algorithm>
#include <utility>

#include "verify/circuits/folding.hpp"
#include "verify/circuits/recurring_uses.hpp"
#include "verify/waiting/waiting_cycles.hpp"

namespace tessera::verify {
namespace {

/// Why nothing is known of the group: a behaviour may have no successor, or the waits at a channel depend on
/// its own net.
std::string unfit(const CommunicationStructure& structure, const CircuitGroup& group) {
  for (const SubsystemFlowId subsystem : group.subsystems)
    for (const BehaviourFlow& behaviour : structure[subsystem].behaviours) {
      if (!behaviour.complete)
        return "after '" + behaviour.name + "' none of the initial conditions may hold";
      for (const Stage& stage : behaviour.stages)
        for (const Communication& communication : stage)
          if (const ChannelFlow& channel = structure[communication.flow]; channel.own_model)
            return "'" + channel.name + "' has a communication model of its own";
    }
  return {};
}

std::string suspicion(const CommunicationStructure& structure, const WaitingCycleSearch& search) {
  const Wait& wait = search.suspected().front();
  const std::string who = structure[wait.subsystem].name;
  const std::string where = "'" + who + "' waits at " + structure[wait.channel].name;
  if (search.deserted() && !wait.waiting_for.valid()) return with_absence(where, structure[wait.channel]);
  if (search.deserted())
    return where + " for " + structure[wait.waiting_for].name + ", which need not come back to it";
  CircuitGroup cycle;
  cycle.circuit = search.suspected();
  return "it is not excluded that " + in_words(structure, cycle);
}

}  // namespace

WaitingReport judge_waiting(const CommunicationStructure& structure,
                            std::span<const CircuitGroup* const> groups, const explore::Limits& limits) {
  WaitingReport report;
  report.goes_on.resize(structure.subsystems.size(), false);
  const auto refuse = [&](std::string why) {
    if (report.why_not.empty()) report.why_not = std::move(why);
  };
  std::vector<const CircuitGroup*> group_of(structure.subsystems.size(), nullptr);
  std::vector<SubsystemFlowId> judged;
  for (const CircuitGroup* group : groups) {
    if (std::string why = unfit(structure, *group); !why.empty()) {
      refuse(std::move(why));
      continue;
    }
    for (const SubsystemFlowId subsystem : group->subsystems) {
      group_of[subsystem.value] = group;
      judged.push_back(subsystem);
    }
  }
  explore::Watch watch(limits);
  WaitingCycleSearch search(structure, judged, watch);
  WaitingCycleSearch::End end = search.run();
  while (end == WaitingCycleSearch::End::suspected) {
    refuse(suspicion(structure, search));
    const CircuitGroup* const group = group_of[search.suspected().front().subsystem.value];
    search.give_up_on(group->subsystems);
    for (const SubsystemFlowId subsystem : group->subsystems) group_of[subsystem.value] = nullptr;
    end = search.run();
  }
  if (end == WaitingCycleSearch::End::gave_up) refuse(watch.why());
  if (end == WaitingCycleSearch::End::excluded)
    for (const SubsystemFlowId subsystem : judged)
      report.goes_on[subsystem.value] = group_of[subsystem.value] != nullptr;
  report.complete = end == WaitingCycleSearch::End::excluded;
  report.stops = search.stops();
  report.traps = search.traps();
  return report;
}

std::vector<bool> flowing_channels(const CommunicationStructure& structure,
                                   const std::vector<bool>& goes_on) {
  const RecurringUses uses(structure);
  const auto uses_for_ever = [&](SubsystemFlowId subsystem, ChannelFlowId channel, Side side) {
    return subsystem.valid() && goes_on[subsystem.value] && uses.comes_back(channel, side);
  };
  std::vector<bool> flows;
  for (std::uint32_t index = 0; index < structure.channels.size(); ++index) {
    const ChannelFlowId id{index};
    const ChannelFlow& channel = structure[id];
    // If the sender may take its value back and the reader may pass by, the two can keep missing each other.
    const bool meet = waits_to_receive(channel) || !channel.send_timeout;
    flows.push_back(uses_for_ever(channel.receiver, id, Side::receive) &&
                    (channel.always_readable || (meet && uses_for_ever(channel.sender, id, Side::send))));
  }
  return flows;
}

}  // namespace tessera::verify
