#pragma once

#include "drivers/run_control.hpp"
#include "recorder/recorder.hpp"
#include "system/clock.hpp"

namespace tessera {

/// Notices that an emergency stop begins or ends, and reports it on the terminal and in the recording.
///
/// Threads: the one that runs the subsystems.
class EmergencyWatch {
 public:
  enum class News : std::uint8_t { none, begins, ends };
  [[nodiscard]] News look(const RunControl& control) {
    // Counted, because one stop may end and another begin between two looks.
    if (const std::uint32_t begun = control.emergencies(); begun != begun_) {
      begun_ = begun;
      stands_ = true;
      return News::begins;
    }
    if (!stands_ || control.emergency()) return News::none;
    stands_ = false;
    return News::ends;
  }
  /// Call it after the safe commands were given. lane: the calling thread's; nullptr: nothing is recorded.
  static void say(News news, const RunControl& control, Time now, RecordingLane* lane);

 private:
  std::uint32_t begun_ = 0;
  bool stands_ = false;
};

}  // namespace tessera
