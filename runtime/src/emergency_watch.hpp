#pragma once

#include "clock.hpp"
#include "recorder.hpp"
#include "run_control.hpp"

namespace tessera {

/// Notices that an emergency stop begins or ends, and says so on the terminal and in the recording.
///
/// Threads: who runs the subsystems.
class EmergencyWatch {
 public:
  enum class News : std::uint8_t { none, begins, ends };
  [[nodiscard]] News look(const RunControl& control) {
    if (control.emergency() == stands_) return News::none;
    stands_ = !stands_;
    return stands_ ? News::begins : News::ends;
  }
  /// After the safe commands were given. lane: the calling thread's; nullptr: nothing is recorded.
  static void say(News news, const RunControl& control, Time now, RecordingLane* lane);

 private:
  bool stands_ = false;
};

}  // namespace tessera
