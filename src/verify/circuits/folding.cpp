#include "verify/circuits/folding.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <tuple>
#include <utility>

namespace tessera::verify {
namespace {

using Flags = std::vector<bool>;

/// The behaviours reached from one over at least one step, itself by repetition.
Flags followers(const SubsystemFlow& subsystem, std::uint32_t start) {
  Flags reached(subsystem.behaviours.size(), false);
  std::vector<std::uint32_t> open{start};
  while (!open.empty()) {
    const std::uint32_t at = open.back();
    open.pop_back();
    const BehaviourFlow& behaviour = subsystem.behaviours[at];
    if (behaviour.repeats) reached[at] = true;
    for (const std::uint32_t next : behaviour.next) {
      if (reached[next]) continue;
      reached[next] = true;
      open.push_back(next);
    }
  }
  return reached;
}

/// The stages of a behaviour, without the channels at which no subsystem may have to wait (holds_up).
std::vector<Stage> essence(const BehaviourFlow& behaviour, const CommunicationStructure& structure) {
  std::vector<Stage> stages;
  for (const Stage& stage : behaviour.stages) {
    Stage kept;
    std::ranges::copy_if(stage, std::back_inserter(kept), [&](const Communication& communication) {
      return holds_up(structure[communication.flow]);
    });
    std::ranges::sort(kept, {}, [](const Communication& communication) {
      return std::tuple(communication.flow, communication.side);
    });
    if (!kept.empty()) stages.push_back(std::move(kept));
  }
  return stages;
}

class Folding {
 public:
  Folding(const SubsystemFlow& subsystem, const CommunicationStructure& structure)
      : subsystem_(subsystem), structure_(structure), rest_(subsystem.behaviours.size(), true) {
    for (const BehaviourFlow& behaviour : subsystem.behaviours) {
      stages_.push_back(essence(behaviour, structure));
      folded_.can_end = folded_.can_end || behaviour.ends;
    }
  }

  Folded result() {
    for (const BehaviourFlow& behaviour : subsystem_.behaviours)
      if (!behaviour.complete)
        return refuse("after '" + behaviour.name + "' none of the initial conditions may hold");
    // A subsystem that neither waits for others nor makes others wait may do anything.
    if (std::ranges::all_of(stages_, [](const auto& stages) { return stages.empty(); })) return folded_;
    if (const std::string name = own_model(); !name.empty())
      return refuse("'" + name + "' has a communication model of its own");
    std::uint32_t at = 0;
    while (!same_from(at)) {
      if (unroll(at)) return folded_;
      if (!peel(at)) return refuse("its behaviours use different channels, or in different orders");
    }
    if (!goes_round(at)) return refuse("it cannot go on for ever");
    folded_.cycle = stages_[at];
    return folded_;
  }

 private:
  Folded refuse(std::string why) {
    folded_.why_not = "'" + subsystem_.name + "': " + std::move(why);
    return folded_;
  }

  /// A channel of the author's own model.
  [[nodiscard]] std::string own_model() const {
    for (const BehaviourFlow& behaviour : subsystem_.behaviours)
      for (const Stage& stage : behaviour.stages)
        for (const Communication& communication : stage)
          if (structure_[communication.flow].own_model) return structure_[communication.flow].name;
    return {};
  }

  [[nodiscard]] bool same_from(std::uint32_t start) const {
    for (std::uint32_t index = 0; index < stages_.size(); ++index)
      if (rest_[index] && stages_[index] != stages_[start]) return false;
    return true;
  }

  /// Takes the behaviour off the front as a start-up: one behaviour may follow, it never comes back, and it
  /// does not wait.
  bool peel(std::uint32_t& at) {
    const BehaviourFlow& behaviour = subsystem_.behaviours[at];
    if (behaviour.next.empty()) return false;
    const std::uint32_t next = behaviour.next.front();
    if (!std::ranges::all_of(behaviour.next, [&](std::uint32_t other) { return other == next; }))
      return false;
    if (next == at || followers(subsystem_, next)[at]) return false;
    for (const Stage& stage : stages_[at])
      for (const Communication& communication : stage) {
        if (communication.side == Side::receive || communication.blocking) return false;
        folded_.primed.push_back(communication.flow);
      }
    rest_[at] = false;
    at = next;
    return true;
  }

  /// Behaviours that follow each other in one fixed cycle, each for one round, are one longer round. Each side
  /// of a channel has one event in it.
  bool unroll(std::uint32_t start) {
    std::vector<Stage> cycle;
    std::set<std::pair<ChannelFlowId, Side>> used;
    std::size_t passed = 0;
    std::uint32_t at = start;
    do {
      const BehaviourFlow& behaviour = subsystem_.behaviours[at];
      if (behaviour.repeats || behaviour.ends || behaviour.next.empty()) return false;
      const std::uint32_t next = behaviour.next.front();
      if (!std::ranges::all_of(behaviour.next, [&](std::uint32_t other) { return other == next; }))
        return false;
      for (const Stage& stage : stages_[at]) {
        for (const Communication& communication : stage)
          if (!used.emplace(communication.flow, communication.side).second) return false;
        cycle.push_back(stage);
      }
      at = next;
    } while (++passed <= rest_.size() && at != start);
    if (at != start || passed != static_cast<std::size_t>(std::ranges::count(rest_, true))) return false;
    folded_.cycle = std::move(cycle);
    return true;
  }

  [[nodiscard]] bool goes_round(std::uint32_t start) const {
    Flags reached = followers(subsystem_, start);
    reached[start] = true;
    for (std::uint32_t index = 0; index < reached.size(); ++index)
      if (reached[index] && followers(subsystem_, index)[index]) return true;
    return false;
  }

  const SubsystemFlow& subsystem_;
  const CommunicationStructure& structure_;
  Flags rest_;                              // per behaviour: not taken off as a start-up
  std::vector<std::vector<Stage>> stages_;  // per behaviour
  Folded folded_;
};

}  // namespace

bool waits_to_send(const ChannelFlow& channel) {
  return channel.sender.valid() && channel.send_blocks && !channel.send_timeout;
}
bool waits_to_receive(const ChannelFlow& channel) {
  return channel.receiver.valid() && channel.receive_blocks && !channel.receive_timeout;
}
bool holds_up(const ChannelFlow& channel) {
  return channel.own_model || waits_to_send(channel) || waits_to_receive(channel);
}

Folded fold(const SubsystemFlow& subsystem, const CommunicationStructure& structure) {
  return Folding(subsystem, structure).result();
}

}  // namespace tessera::verify
