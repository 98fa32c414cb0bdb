#include "project/process/restart_gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <optional>
#include <utility>

namespace tessera::project {

RestartGate::RestartGate(const std::filesystem::path& folder, const std::string& system,
                         const std::string& net_hash)
    : system_(system) {
  // Signals are for the thread that runs the processes.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  thread_ = std::thread(
      [this, watch = DeploymentWatch(folder, system, net_hash)]() mutable { watch_on(std::move(watch)); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

RestartGate::~RestartGate() {
  ending_ = true;
  thread_.join();
}

void RestartGate::watch_on(DeploymentWatch watch) {
  while (!ending_) {
    static_cast<void>(watch.poll(std::chrono::milliseconds(100)));
    std::vector<Seen> now;
    for (const WatchedProcess* one : watch.processes())
      now.push_back({one->name(), one->state, one->heard, one->snapshot.emergency});
    const std::lock_guard lock(mutex_);
    seen_ = std::move(now);
  }
}

void RestartGate::failed(const std::string& process) {
  const std::lock_guard lock(mutex_);
  Held& held = held_[process] = {};
  note_stops(process, held);
}

void RestartGate::note_stops(const std::string& process, Held& held) const {
  for (const Seen& one : seen_)
    if (one.name != process && one.stands()) held.stood.insert(one.name);
}

/// A process that is silent cannot say more than it has.
bool RestartGate::is_fresh(const std::string& process, Clock::time_point since) const {
  return std::ranges::all_of(seen_, [&](const Seen& one) {
    return one.name == process || one.state != WatchedProcess::State::running || one.heard >= since;
  });
}

/// "gate, rover[1] (smoke)"; empty: none stands in an emergency stop.
std::string RestartGate::standing_besides(const std::string& process) const {
  std::string names, why;
  for (const Seen& one : seen_) {
    if (one.name == process || !one.stands()) continue;
    names += (names.empty() ? "" : ", ") + one.name;
    why = *one.emergency;
  }
  return names.empty() ? names : fmt::format("{} ({})", names, why);
}

RestartGate::Verdict RestartGate::ask(const std::string& process) {
  const std::lock_guard lock(mutex_);
  Held& held = held_[process];
  if (!held.asked) held.asked = Clock::now();
  note_stops(process, held);
  if (!is_fresh(process, *held.asked)) return {.answer = Answer::wait, .why = {}};
  Verdict verdict = decide(process, held);
  if (verdict.answer != Answer::wait) held_.erase(process);
  return verdict;
}

RestartGate::Verdict RestartGate::decide(const std::string& process, const Held& held) const {
  if (const std::string standing = standing_besides(process); !standing.empty())
    return {
        .answer = Answer::wait,
        .why = fmt::format("an emergency stop stands at {}; `tessera reset {}` ends it", standing, system_)};
  const auto was_reset = [&](const Seen& one) { return held.stood.contains(one.name) && one.runs(); };
  if (std::ranges::any_of(seen_, was_reset)) return {};
  if (!held.stood.empty())
    return {.answer = Answer::closed,
            .why = "the processes with the emergency stop have ended without a reset"};
  const auto own = std::ranges::find(seen_, process, &Seen::name);
  if (own == seen_.end() || !own->emergency) return {};
  return {.answer = Answer::closed,
          .why = fmt::format("it failed in an emergency stop ({}), which no reset can end any more",
                             *own->emergency)};
}

}  // namespace tessera::project
