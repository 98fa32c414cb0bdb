#pragma once

#include <functional>

#include "tessera/controller.hpp"

namespace tessera {

/// How a run on the steady clock ends if user code does not return after the run was told to stop.
struct GiveUp {
  /// Ends the process, since the threads that run user code still use what the run has made. The recording is
  /// closed by then, and the run has failed. Empty: the run waits for ever.
  std::function<void(const RunSummary&)> end_process{};
  /// The time since the stop while some device has not taken its safe command. A guardian tries it when the
  /// process has ended, so this is short.
  Duration unsafe = std::chrono::seconds(4);
  /// The same if all devices are safe. It is shorter than the time that systemd is told to wait
  /// (docs/service.md), which closes no recording.
  Duration safe = std::chrono::seconds(8);
};

}  // namespace tessera
