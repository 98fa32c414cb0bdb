#pragma once

#include <cstdint>
#include <string_view>

#include "drivers/run_control.hpp"
#include "recorder/recorder.hpp"
#include "subsystem/subsystem_parts.hpp"
#include "system/clock.hpp"

namespace tessera {

/// The reports of one subsystem: log lines and faults, which go to the terminal and the recording, and the
/// faults that end the run.
///
/// Threads: that of the subsystem, unless said otherwise. Allocates nothing.
class Reports {
 public:
  /// lane: nullptr: nothing is recorded.
  Reports(const SubsystemParts& parts, RunControl& control, const Clock& clock, RecordingLane* lane)
      : parts_(parts), control_(control), clock_(clock), lane_(lane) {}

  /// Does not return while the process ends without waiting for the subsystem.
  void log(LogLevel level, std::string_view text) const;
  /// Reports a fault in a place of this subsystem.
  void report(Fault fault, std::string_view place, std::string_view what) const {
    report(fault, place, what, lane_);
  }
  /// The same from another thread, with the lane of that thread.
  void report(Fault fault, std::string_view place, std::string_view what, RecordingLane* lane) const;
  /// Reports a fault because of which nothing fails, with the lane of the calling thread.
  void tell(Fault fault, std::string_view place, std::string_view what, RecordingLane* lane) const;
  /// Stops the run, which has failed because of this subsystem.
  void fail_run(std::string_view what) const;
  /// Records what has happened to the thread of the subsystem. Async-signal-safe.
  void record_death(std::string_view text) const {
    if (lane_ != nullptr)
      lane_->text(Event::Kind::fault, clock_.now(), static_cast<std::uint32_t>(Fault::crash), text);
  }

 private:
  struct Written {
    Fault of;
    bool is_told = false;
  };
  /// effect: comes behind `what`.
  void write(Written fault, std::string_view place, std::string_view what, std::string_view effect,
             RecordingLane* lane) const;

  const SubsystemParts& parts_;
  RunControl& control_;
  const Clock& clock_;
  RecordingLane* lane_;
};

}  // namespace tessera
