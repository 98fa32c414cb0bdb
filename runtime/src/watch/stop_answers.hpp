#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/effectors.hpp"
#include "drivers/run_control.hpp"
#include "subsystem/subsystem_executor.hpp"
#include "system/waker.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/result.hpp"
#include "watch/monitor_client.hpp"

namespace tessera {

/// The answers to emergency stops of operators. Each waits until all devices have taken their safe commands, or
/// for as long as Effectors::patience: an operator who reads that the stop is done comes near the devices.
///
/// Threads: that of the monitor.
class StopAnswers {
 public:
  /// Both must outlive it.
  StopAnswers(const std::vector<std::unique_ptr<SubsystemExecutor>>& executors, const RunControl& control)
      : executors_(executors), control_(control) {}

  void await(MonitorClient& client, std::int64_t id) {
    awaited_.push_back({&client, id, monotonic_ns() + Effectors::patience.count()});
  }
  /// The client has gone.
  void forget(const MonitorClient& client) {
    std::erase_if(awaited_, [&](const Awaited& one) { return one.client == &client; });
  }
  [[nodiscard]] bool none() const { return awaited_.empty(); }

  using Answer = std::function<void(MonitorClient&, const CommandAnswer& answer)>;
  /// Gives the answers that are known by now.
  void give(const Answer& answer) { give(answer, /*all=*/false); }
  /// Gives all answers, because nobody will look at the devices any more.
  void give_all(const Answer& answer) { give(answer, /*all=*/true); }

  /// Names the devices that have not taken their safe command since the stop began; nullopt: all have.
  [[nodiscard]] std::optional<Problem> not_safe_yet() const {
    std::vector<std::string> names;
    for (const auto& executor : executors_)
      std::ranges::move(executor->effectors().not_stopped(), std::back_inserter(names));
    return names.empty() ? std::nullopt : std::optional(Problem{not_safe(names)});
  }

 private:
  struct Awaited {
    MonitorClient* client;
    std::int64_t id, until_ns;
  };
  void give(const Answer& answer, bool all) {
    if (awaited_.empty()) return;
    const bool stands = control_.emergency();
    const std::optional<Problem> wrong =
        stands ? not_safe_yet() : Problem{"`tessera reset` has ended the emergency stop"};
    const std::int64_t now_ns = monotonic_ns();
    std::erase_if(awaited_, [&](const Awaited& one) {
      if (!all && stands && wrong && now_ns < one.until_ns) return false;
      answer(*one.client, {.id = one.id, .problem = wrong});
      return true;
    });
  }

  const std::vector<std::unique_ptr<SubsystemExecutor>>& executors_;
  const RunControl& control_;
  std::vector<Awaited> awaited_;
};

}  // namespace tessera
