#include "watch/liveness.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace tessera {

Liveness::Liveness(Assembly& assembly, Guardian* guardian) : assembly_(assembly), guardian_(guardian) {
  if (guardian_ != nullptr) guardian_->watch_beats();
  manager_.ready();
  tell_status();
}

Liveness::~Liveness() {
  if (guardian_ != nullptr) guardian_->ignore_beats();
}

Time Liveness::show(Time now) {
  Time next = Time::max();
  if (guardian_ != nullptr) {
    if (now >= next_beat_) {
      guardian_->beat();
      next_beat_ = now + Guardian::beat_period;
    }
    if (guardian_->has_acted())
      assembly_.control.request_stop(Guardian::describe(Guardian::Trouble::acted), /*fault=*/true);
    next = next_beat_;
  }
  const bool stalled = somebody_stalls();
  if (stalled != std::exchange(stalled_, stalled)) tell_status();
  // During a stall, asks again soon: the manager must get its sign of life when the stall is over.
  return stalled ? std::min(next, now + Guardian::beat_period) : std::min(next, manager_.beat(now));
}

void Liveness::suspend() {
  if (guardian_ != nullptr) guardian_->ignore_beats();
}

void Liveness::resume() {
  if (guardian_ != nullptr) guardian_->watch_beats();
}

void Liveness::tell_status() {
  manager_.status(
      stalled_ ? "a subsystem stalls: its transition function does not return"
               : fmt::format("{}: {} subsystems run", assembly_.system.name, assembly_.executors.size()));
}

bool Liveness::somebody_stalls() const {
  for (std::uint32_t instance = 0; instance < assembly_.executors.size(); ++instance)
    if (assembly_.control.is_stalled(instance)) return true;
  return false;
}

}  // namespace tessera
