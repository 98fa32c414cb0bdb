#pragma once

#include <functional>

#include "tessera/controller.hpp"

namespace tessera {

/// How a run on the steady clock ends if user code does not return after the run was told to stop.
struct GiveUp {
  /// Ends the process, because the threads that run user code still use the objects of the run. The recording
  /// is closed by then, and the run has failed. Empty: the run waits without a limit.
  std::function<void(const RunSummary&)> end_process{};
  /// The time since the stop if some device has not taken its safe command. A guardian tries again when the
  /// process has ended, so this is short.
  Duration unsafe = std::chrono::seconds(4);
  /// The same if all devices are safe. It is shorter than the stop time of the systemd unit
  /// (docs/use/service.md), because a kill by systemd would leave the recording open.
  Duration safe = std::chrono::seconds(8);
};

}  // namespace tessera
