#pragma once

#include <cstdint>
#include <vector>

#include "nets/flat_net.hpp"
#include "recorder/recorder.hpp"

namespace tessera {

/// The layers of the system and of the agents: the transitions t_in and t_out of each. The driver of a run
/// reports which subsystems have ended; nothing else in the net depends on it.
///
/// Threads: the driver's.
class UpperLayers {
 public:
  /// agents: those that run here; numbers: their numbers in the whole system. of_system: they are all agents,
  /// and the transitions of the system fire.
  UpperLayers(const System& whole, const std::vector<AgentSpan>& agents,
              const std::vector<std::uint32_t>& numbers, bool of_system, RecordingLane* lane);

  /// Fires t_in of the system and of every agent. Then every subsystem may be entered.
  void enter(Time now);
  /// Fires t_out of the agent if this was its last subsystem, and t_out of the system if this was
  /// the last agent.
  void subsystem_ended(std::uint32_t instance, Time now);
  /// The process of this agent has died. If it begins again, so does the agent. Returns whether the agent had
  /// not ended yet.
  bool agent_died(std::uint32_t agent);
  void agent_begins_again(std::uint32_t agent, Time now);
  /// The agent of a subsystem.
  [[nodiscard]] std::uint32_t agent_of(std::uint32_t instance) const { return agent_of_[instance]; }
  /// Whether all agents that have not died have ended.
  [[nodiscard]] bool ended() const { return agents_left_ == 0; }
  [[nodiscard]] std::uint64_t firings() const { return firings_; }

 private:
  void fire(std::uint32_t transition, Time now);
  std::vector<std::uint32_t> agent_of_;  // per instance
  std::vector<std::uint32_t> left_;      // per agent: subsystems that have not ended
  // Into FlatNet::transitions, per agent and of the system.
  std::vector<std::uint32_t> starts_, ends_;
  std::uint32_t system_starts_, system_ends_;
  bool of_system_;
  std::uint32_t agents_left_;
  std::vector<std::uint32_t> size_;  // per agent: subsystems
  std::vector<bool> is_dead_;        // per agent
  RecordingLane* lane_;
  std::uint64_t firings_ = 0;
};

}  // namespace tessera
