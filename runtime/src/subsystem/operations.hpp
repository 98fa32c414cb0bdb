#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/run_control.hpp"
#include "recorder/recorder.hpp"
#include "subsystem/channel_values.hpp"
#include "subsystem/device_commands.hpp"
#include "subsystem/goals.hpp"
#include "subsystem/reports.hpp"
#include "subsystem/subsystem_parts.hpp"
#include "subsystem/written_outputs.hpp"
#include "system/clock.hpp"
#include "tessera/context.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/tables.hpp"

namespace tessera {

/// The data part of a subsystem: the effects of its operations and conditions on buffers, devices and user
/// code. It does not know the net.
///
/// *Failure.* An iteration fails when user code throws, a device fails, an output is not finite, or the
/// transition function takes longer than the watchdog, or than `takes` with Overtime::fault, allows. The outputs then become those of the iteration
/// before, and are sent marked as invalid until an iteration succeeds. So is an output that was never written
/// (WrittenOutputs). An effector gets its safe command at once. The outcome is error, whatever the conditions say.
///
/// Channels and devices have classes of their own (ChannelValues, DeviceCommands).
///
/// Threads: the subsystem's.
class Operations final : public ContextServices {
 public:
  Operations(SubsystemParts parts, RunControl& control, const Clock& clock, RecordingLane* lane);
  Operations(const Operations&) = delete;
  Operations& operator=(const Operations&) = delete;
  ~Operations() { destroy_drivers(parts_); }

  // Operations of places.
  /// An iteration of a subsystem that receives first. (In the other order it begins with start_call.)
  void begin_iteration(std::uint16_t behaviour);
  /// missed: the number of missed instants of the rate. If it is not zero, this is a fault: the function is
  /// not called, and the iteration fails.
  void start_call(std::uint16_t behaviour, Time now, std::uint64_t missed = 0);
  void finish_call(Time now);
  void count() { ++iteration_; }
  void write(std::uint32_t port, std::uint16_t slot, Time now);
  void read(std::uint32_t port, std::uint16_t slot, Time now) { channels_.read(port, slot, now); }
  /// The state that the memory of a goal has after the last read over that port, which tells of it.
  [[nodiscard]] std::uint16_t told(std::uint32_t port) { return goals_.told(port, channels_.took(port)); }
  /// A timeout transition of that port has fired.
  void note_timeout(std::uint32_t port) { channels_.note_timeout(port); }
  /// A blocking send of that port was acknowledged in time.
  void note_answer(std::uint32_t port) { channels_.note_answer(port); }

  /// A token has arrived in the place of that value of a fact of the net.
  void learn(std::uint16_t fact, std::uint16_t value, Time now);

  // Conditions. Ages are those at `now`; a condition that throws is an error.
  [[nodiscard]] Outcome decide(std::uint16_t behaviour, Time now);
  /// As decide, with an outcome that was decided elsewhere: no condition is evaluated.
  void accept_outcome(Outcome outcome);
  /// no_entry: no entry holds. unknown_entry: a condition has thrown; this has been logged.
  static constexpr int no_entry = -1, unknown_entry = -2;
  [[nodiscard]] int route(std::uint16_t behaviour, Time now);
  /// Whether this iteration sends over the port what it may skip.
  [[nodiscard]] bool sends(std::uint16_t behaviour, std::uint16_t port, Time now);

  // Times that the specification declares.
  /// The thread of the subsystem has gone on so long after it might. place: where its token is.
  void note_wakeup(Duration late, std::string_view place);
  [[nodiscard]] Overtimes& overtimes() { return overtimes_; }
  [[nodiscard]] const Overtimes& overtimes() const { return overtimes_; }

  [[nodiscard]] bool has_failed() const { return failed_; }
  /// Marks the last transition function as failed, for the reason that it had in a recorded run.
  void fail_as_recorded(Fault fault, std::string_view what) { fail(fault, behaviour_, what); }

  [[nodiscard]] DeviceCommands& devices() { return devices_; }
  [[nodiscard]] const DeviceCommands& devices() const { return devices_; }
  [[nodiscard]] const Reports& reports() const { return reports_; }

  void log(LogLevel level, std::string_view text) override { reports_.log(level, text); }
  void stop(std::string_view reason) override;
  void emergency_stop(std::string_view reason) override;
  void broken(std::string_view assertion) override;
  /// The transition function of `behaviour` has run longer than the watchdog allows, and has not returned.
  /// Threads: any, with a lane of its own.
  void report_stall(std::uint16_t behaviour, RecordingLane* lane) const;

  /// "read() of robot.sonar.distance" while that driver is being read; empty: none is. Threads: any.
  [[nodiscard]] std::string driver_being_read() const;

  [[nodiscard]] const SubsystemParts& parts() const { return parts_; }
  /// The simulated time of the next call.
  [[nodiscard]] Duration draw_time(std::uint16_t behaviour) {
    const Duration declared = parts_.times.draw(parts_.instance->net->behaviours[behaviour]);
    return parts_.faulty == nullptr ? declared : declared + parts_.faulty->take_delay();
  }
  [[nodiscard]] PresentTimes& present() { return present_; }
  [[nodiscard]] const PresentTimes& present() const { return present_; }
  [[nodiscard]] bool has_inputs() const {
    return channels_.has_inputs() || !parts_.bindings.real_inputs.empty();
  }
  [[nodiscard]] bool ended_by_error() const { return erroneous_; }
  [[nodiscard]] std::uint64_t iterations() const { return calls_; }
  [[nodiscard]] std::uint64_t errors() const { return errors_; }

 private:
  void begin_behaviour(std::uint16_t behaviour);
  void take_changes(Time now);
  void read_receptors(Time now);
  [[nodiscard]] bool read_receptor(std::size_t index, Time now);
  void send_commands(Time now);
  void finish_readings(Time now);
  void fail_late(std::uint64_t missed);
  void check_watchdog(Time now);
  void check_overtime(Time now);
  void tell_overtime(Time now);
  void check_outputs();
  void check_skips(std::uint16_t behaviour);
  void refresh_ages(Time now);
  void fail_in(Fault fault, std::uint16_t behaviour, std::string_view activity, std::string_view what);
  void fail(Fault fault, std::uint16_t behaviour, std::string_view what);
  [[nodiscard]] std::string_view place_of_call(std::uint16_t behaviour) const;
  template <class Code>
  [[nodiscard]] bool survives(Fault fault, std::uint16_t behaviour, std::string_view activity, Code&& code);

  SubsystemParts parts_;
  Context& context_;
  RunControl& control_;
  const Clock& clock_;
  RecordingLane* lane_;
  Reports reports_;
  ChannelValues channels_;
  DeviceCommands devices_;
  WrittenOutputs written_;
  Goals goals_;
  Overtimes overtimes_;
  PresentTimes present_;
  struct KeptCell {
    const Bindings::KeptCell* cell = nullptr;  // nullptr: the fact is no memory
    std::uint16_t value = 0;
  };
  std::vector<KeptCell> kept_;                        // per fact of the net
  std::vector<const Bindings::Outgoing*> checked_;    // outputs that must be finite
  std::vector<const Bindings::Outgoing*> skippable_;  // outputs that some behaviour may skip
  Time called_at_{};
  Time began_at_{};              // the behaviour: its first call
  bool has_ended_ = true;        // the last behaviour; the next call is the first of another
  bool begun_ = false;           // the behaviour after one that has ended
  std::uint64_t iteration_ = 0;  // i of the paper
  std::uint64_t calls_ = 0, errors_ = 0;
  std::uint16_t behaviour_ = 0;            // the behaviour called last
  std::atomic<std::uint32_t> reading_{0};  // 1 + number of the real input that is being read; 0: none
  bool failed_ = false;                    // the last transition function has failed
  bool receives_first_ = false;            // iterations begin with begin_iteration
  bool erroneous_ = false;                 // the last outcome was error
};

}  // namespace tessera
