#include "assembly/upper_layers.hpp"

#include <algorithm>
#include <functional>

namespace tessera {

UpperLayers::UpperLayers(const System& whole, const std::vector<AgentSpan>& agents,
                         const std::vector<std::uint32_t>& numbers, bool of_system, RecordingLane* lane)
    : system_starts_(system_transition(whole, Step::start_system)),
      system_ends_(system_transition(whole, Step::end_system)),
      of_system_(of_system),
      agents_left_(static_cast<std::uint32_t>(agents.size())),
      lane_(lane) {
  for (std::uint32_t agent = 0; agent < agents.size(); ++agent) {
    agent_of_.resize(agents[agent].end, agent);
    left_.push_back(agents[agent].end - agents[agent].first);
  }
  for (const std::uint32_t number : numbers) {
    starts_.push_back(agent_transition(whole, number, Step::start_agent));
    ends_.push_back(agent_transition(whole, number, Step::end_agent));
  }
  size_ = left_;
  is_dead_.resize(agents.size());
}

bool UpperLayers::agent_died(std::uint32_t agent) {
  const bool had_ended = left_[agent] == 0;
  if (!had_ended) --agents_left_;
  is_dead_[agent] = true;
  return !had_ended;
}

void UpperLayers::agent_begins_again(std::uint32_t agent, Time now) {
  is_dead_[agent] = false;
  left_[agent] = size_[agent];
  ++agents_left_;
  fire(starts_[agent], now);
}

void UpperLayers::enter(Time now) {
  if (of_system_) fire(system_starts_, now);
  for (std::uint32_t agent = 0; agent < left_.size(); ++agent) fire(starts_[agent], now);
}

void UpperLayers::subsystem_ended(std::uint32_t instance, Time now) {
  const std::uint32_t agent = agent_of_[instance];
  if (--left_[agent] > 0) return;
  fire(ends_[agent], now);
  const bool all = --agents_left_ == 0 && std::ranges::none_of(is_dead_, std::identity{});
  if (all && of_system_) fire(system_ends_, now);
}

void UpperLayers::fire(std::uint32_t transition, Time now) {
  ++firings_;
  if (lane_ != nullptr) lane_->firing(now, transition, 0);
}

}  // namespace tessera
