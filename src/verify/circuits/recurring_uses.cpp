#include "verify/circuits/recurring_uses.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "verify/circuits/event_graph.hpp"

namespace tessera::verify {
namespace {

/// The sets of behaviours that a subsystem cannot leave once it is there, each by a number.
struct LastSets {
  std::vector<std::uint32_t> set_of;  ///< per behaviour
  std::vector<bool> is_last;          ///< per set: nothing leads out of it
  bool dead_end = false;              ///< after some behaviour nothing follows, not even itself
};

LastSets last_sets(const SubsystemFlow& subsystem) {
  EventGraph graph;
  for (std::size_t index = 0; index < subsystem.behaviours.size(); ++index) static_cast<void>(graph.node({}));
  for (std::uint32_t index = 0; index < subsystem.behaviours.size(); ++index) {
    const BehaviourFlow& behaviour = subsystem.behaviours[index];
    if (behaviour.repeats) graph.edge({.from = index, .to = index});
    for (const std::uint32_t next : behaviour.next) graph.edge({.from = index, .to = next});
  }
  graph.close();
  LastSets sets;
  sets.set_of = graph.components([](const EventGraph::Edge&) { return true; });
  sets.is_last.assign(subsystem.behaviours.size(), true);
  for (std::uint32_t index = 0; index < subsystem.behaviours.size(); ++index) {
    sets.dead_end = sets.dead_end || graph.from(index).empty();
    for (const EventGraph::Edge& edge : graph.from(index))
      if (sets.set_of[edge.to] != sets.set_of[index]) sets.is_last[sets.set_of[index]] = false;
  }
  return sets;
}

}  // namespace

RecurringUses::RecurringUses(const CommunicationStructure& structure)
    : structure_(structure),
      sends_(structure.channels.size(), false),
      receives_(structure.channels.size(), false),
      stays_(structure.subsystems.size(), false) {
  for (std::uint32_t index = 0; index < structure.subsystems.size(); ++index) judge({index});
}

void RecurringUses::judge(SubsystemFlowId id) {
  const SubsystemFlow& subsystem = structure_[id];
  stays_[id.value] = std::ranges::none_of(subsystem.behaviours, &BehaviourFlow::ends) &&
                     std::ranges::all_of(subsystem.behaviours, &BehaviourFlow::complete);
  const LastSets sets = last_sets(subsystem);
  if (sets.dead_end) return;
  // The behaviours of one last set after the other, so that each set counts once for a side.
  std::vector<std::uint32_t> order;
  for (std::uint32_t index = 0; index < subsystem.behaviours.size(); ++index)
    if (sets.is_last[sets.set_of[index]]) order.push_back(index);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t index) { return sets.set_of[index]; });
  struct Count {
    std::uint32_t sets = 0, last = 0;  // last: the set that was counted last, from 1
  };
  std::map<std::pair<ChannelFlowId, Side>, Count> uses;
  std::uint32_t number = 0;
  for (std::size_t at = 0; at < order.size(); ++at) {
    if (at == 0 || sets.set_of[order[at]] != sets.set_of[order[at - 1]]) ++number;
    for (const Stage& stage : subsystem.behaviours[order[at]].stages)
      for (const Communication& communication : stage) {
        Count& count = uses[{communication.flow, communication.side}];
        if (std::exchange(count.last, number) != number) ++count.sets;
      }
  }
  for (const auto& [use, count] : uses)
    (use.second == Side::send ? sends_ : receives_)[use.first.value] = count.sets == number;
}

}  // namespace tessera::verify
