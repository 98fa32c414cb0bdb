// How a subsystem waits when nothing may fire: where it registers, until when, and how that is reported.

#include <fmt/format.h>

#include <algorithm>

#include "subsystem/subsystem_executor.hpp"

namespace tessera {

/// Registers in every channel exactly the needs that this subsystem waits for. false: one of them can be met
/// now.
bool SubsystemExecutor::register_waits() {
  std::fill(wants_next_.begin(), wants_next_.end(), std::uint16_t{0});
  for (const std::uint32_t place : marked_) {
    for (const std::uint32_t index : plan_->leaving_of(place)) {
      const Plan::TransitionEntry& transition = plan_->transitions[index];
      if (!transition.need || !locally_enabled(transition)) continue;
      if (!condition_holds(transition)) continue;
      wants_next_[transition.port.value] =
          static_cast<std::uint16_t>(wants_next_[transition.port.value] | 1U << *transition.need);
    }
  }
  for (std::size_t port = 0; port < wants_.size(); ++port) {
    if (wants_[port] == 0 && wants_next_[port] == 0) continue;
    const PortLink& link = operations_.parts().ports[port];
    if (!link.channel->wait(link.side, wants_next_[port])) return false;
    registrations_ +=
        static_cast<std::uint32_t>(wants_next_[port] != 0) - static_cast<std::uint32_t>(wants_[port] != 0);
    wants_[port] = wants_next_[port];
  }
  return true;
}

Time SubsystemExecutor::next_deadline() const {
  Time deadline = operations_.devices().guard_deadline(now_);
  for (const std::uint32_t place : marked_) {
    const Token& token = tokens_[place];
    if (token.phase != Phase::finished) {
      deadline = std::min(deadline, token.due);
      continue;
    }
    for (const std::uint32_t index : plan_->leaving_of(place)) {
      const Plan::TransitionEntry& transition = plan_->transitions[index];
      if (transition.guard.kind != Guard::Kind::elapsed || !locally_enabled(transition)) continue;
      const Time elapsed = elapses(transition);
      const bool registered = transition.need && (wants_[transition.port.value] >> *transition.need & 1) != 0;
      if (!registered)
        deadline = std::min(deadline, elapsed);  // registered: it has elapsed and waits for its channel
    }
  }
  return deadline;
}

bool SubsystemExecutor::time_stands_still() {
  if (now_ != instant_) {
    instant_ = now_;
    fired_at_instant_ = 0;
  }
  return ++fired_at_instant_ > firings_per_instant;
}

std::optional<std::vector<SubsystemExecutor::Lack>> SubsystemExecutor::lacks() const {
  std::vector<Lack> all;
  for (const std::uint32_t place : marked_) {
    if (tokens_[place].phase != Phase::finished) return std::nullopt;
    for (const std::uint32_t index : plan_->leaving_of(place)) {
      const Plan::TransitionEntry& transition = plan_->transitions[index];
      if (!locally_enabled(transition)) continue;
      const bool needs_time = transition.guard.kind == Guard::Kind::elapsed;
      if (!needs_time && !condition_holds(transition)) continue;
      if (!transition.need) return std::nullopt;
      const auto tokens =
          static_cast<std::uint16_t>(transition.taken & ~ports_[transition.port.value].channel->marking());
      if (tokens == 0) return std::nullopt;
      all.push_back({transition.port.value, tokens});
    }
  }
  if (marked_.empty()) return std::nullopt;  // the subsystem has not begun
  return all;
}

std::vector<std::uint16_t> SubsystemExecutor::may_give(const std::vector<bool>& helped) const {
  std::vector<std::uint16_t> gives(plan_->ports.size()), there(gives.size());
  for (std::size_t port = 0; port < there.size(); ++port)
    there[port] = helped[port] ? UINT16_MAX : ports_[port].channel->marking();
  std::vector<bool> reached(plan_->places.size());
  for (const std::uint32_t place : marked_) reached[place] = true;
  for (std::uint32_t place = 0; place < reached.size(); ++place)
    if (places_[place].fact) reached[place] = true;
  for (bool more = true; more;) {
    more = false;
    for (const Plan::TransitionEntry& transition : plan_->transitions) {
      const auto inputs = plan_->inputs(transition);
      if (!std::all_of(inputs.begin(), inputs.end(), [&](std::uint32_t place) { return reached[place]; }))
        continue;
      if (transition.port.valid()) {
        if ((transition.taken & ~there[transition.port.value]) != 0) continue;
        gives[transition.port.value] =
            static_cast<std::uint16_t>(gives[transition.port.value] | transition.produced);
        more = more || (transition.produced & ~there[transition.port.value]) != 0;
        there[transition.port.value] =
            static_cast<std::uint16_t>(there[transition.port.value] | transition.produced);
      }
      for (const std::uint32_t place : plan_->outputs(transition)) {
        more = more || !reached[place];
        reached[place] = true;
      }
    }
  }
  return gives;
}

std::string SubsystemExecutor::whereabouts(const System& system) const {
  const Instance& instance = *operations_.parts().instance;
  std::string text = path();
  for (const std::uint32_t place : marked_) {
    text += fmt::format(" at {}", instance.net->places[place].name);
    for (const std::uint32_t index : plan_->leaving_of(place)) {
      const Plan::TransitionEntry& transition = plan_->transitions[index];
      if (!transition.port.valid()) continue;
      const InstanceId peer = operations_.parts().ports[transition.port.value].peer;
      const std::string_view port = instance.net->ports[transition.port.value].name;
      if (operations_.parts().ports[transition.port.value].end != nullptr)
        text += fmt::format(" waits for process {} over '{}'",
                            operations_.parts().ports[transition.port.value].remote, port);
      else if (!peer.valid())
        text += fmt::format(" waits for the other end of '{}', which no behaviour uses", port);
      else
        text += fmt::format(" waits for {}.{} over '{}'{}", system.instances[peer.value].agent,
                            system.instances[peer.value].name, port,
                            control_.has_ended(peer.value) ? ", which has ended" : "");
      break;
    }
  }
  return text;
}

}  // namespace tessera
