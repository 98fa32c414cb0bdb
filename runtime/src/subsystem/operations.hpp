#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/command_limits.hpp"
#include "drivers/device_life.hpp"
#include "drivers/effectors.hpp"
#include "drivers/run_control.hpp"
#include "nets/shared_channel.hpp"
#include "recorder/recorder.hpp"
#include "recorder/value_recorder.hpp"
#include "subsystem/injection.hpp"
#include "subsystem/parameter_changes.hpp"
#include "system/clock.hpp"
#include "tessera/device.hpp"
#include "tessera/tables.hpp"

namespace tessera {

/// One end of a channel as its subsystem sees it.
struct PortLink {
  SharedChannel* channel = nullptr;
  Side side = Side::send;
  std::uint32_t buffer = 0;         ///< into Bindings::inputs or outputs
  Duration timeout{0};              ///< zero: waits for ever
  std::uint32_t peer = UINT32_MAX;  ///< instance at the other end; UINT32_MAX: none
};

/// What a subsystem is made of besides its net.
struct SubsystemParts {
  std::string path;
  std::uint32_t index = 0;  ///< into System::instances
  const Instance* instance = nullptr;
  std::unique_ptr<Subsystem> subsystem;
  Bindings bindings;
  std::vector<std::unique_ptr<RealReceptor>> receptors;  ///< as Bindings::real_inputs
  std::vector<std::unique_ptr<RealEffector>> effectors;  ///< as Bindings::real_outputs
  std::vector<DriverInUse> drivers;                      ///< behind receptors and effectors
  std::vector<PortLink> ports;                           ///< as SubsystemNet::ports
  FaultySubsystem* faulty = nullptr;                     ///< `subsystem`, where faults are injected into it
  std::unique_ptr<ValueRecorder> values;                 ///< nullptr: they are not recorded
  ParameterChanges* changes = nullptr;                   ///< nullptr: parameters stay as they are
};

/// The data part of a subsystem: what its operations and conditions do to buffers, devices and user code.
/// Knows no net.
///
/// *Failure.* When user code throws, a device fails, an output is not finite, or the transition function
/// takes longer than the watchdog, the outputs become those of the iteration before, they are sent marked
/// invalid until an iteration succeeds, an effector gets its safe command at once, and the outcome is error
/// whatever the conditions say.
///
/// *Safe command.* Given instead of the outputs
/// - until a valid value has come to every input that the behaviours called so far receive;
/// - while no valid value has arrived on some input for longer than `stale` (counted from the start of the
///   run before the first; an invalid value is no news);
/// - while an emergency stop stands;
/// - for good once a subsystem that feeds an input has ended, and while one stalls.
/// Given at once on failure, and by leave on every way out of the run. It comes first, and is reported then.
/// What a device refuses is tried again; if it refuses for as long as Effectors::patience, the run fails.
///
/// Threads: the subsystem's.
class Operations final : public ContextServices {
 public:
  Operations(SubsystemParts parts, RunControl& control, const Clock& clock, RecordingLane* lane);

  // Operations of places.
  /// missed: so many instants of the rate, which is a fault: the function is not called, and the iteration
  /// fails.
  void start_call(std::uint16_t behaviour, Time now, std::uint64_t missed = 0);
  void finish_call(Time now);
  void count() { ++iteration_; }
  void write(std::uint32_t port, std::uint16_t slot, Time now);
  void read(std::uint32_t port, std::uint16_t slot, Time now);

  // Conditions. Ages are those of `now`; what throws is an error.
  [[nodiscard]] Outcome decide(std::uint16_t behaviour, Time now);
  /// As decide, of what is decided elsewhere: no condition is evaluated.
  void accept_outcome(Outcome outcome);
  /// no_entry: none holds; unknown_entry: a condition has thrown, which has been logged.
  static constexpr int no_entry = -1, unknown_entry = -2;
  [[nodiscard]] int route(std::uint16_t behaviour, Time now);

  [[nodiscard]] bool has_failed() const { return failed_; }
  /// The last transition function has failed for a reason that is not here, as in a recorded run.
  void fail_as_recorded(Fault fault, std::string_view what) { fail(fault, behaviour_, what); }

  /// Opens the devices; an effector gets its safe command as soon as its device is open. false and `error`:
  /// one could not be opened or refuses; what is open must still be closed. Threads: before the run.
  [[nodiscard]] bool open_devices(std::string& error);
  /// Closes those that are open and returns what went wrong. Threads: after the run.
  std::vector<std::string> close_devices() { return devices_.close(); }

  /// A timeout transition of that port has fired.
  void note_timeout(std::uint32_t port);
  /// A blocking send of that port was acknowledged in time.
  void note_answer(std::uint32_t port);

  /// Calls the heartbeats that are due. place: where the token is.
  void beat(Time now, std::string_view place);
  /// When `beat` must be called next; Time::max(): no device wants heartbeats.
  [[nodiscard]] Time next_beat() const { return devices_.next_beat(); }
  /// The safe command because the subsystem or the run ends.
  void leave() { give_safe_command({SafeReason::Kind::leaves}); }
  /// Tries again, for as long as Effectors::patience, where a device has not taken it.
  void insist();
  /// Calls heartbeats that are due. Gives the safe command if an input is stale or its source has ended or
  /// stalls, and it has not been given for that reason, and again where a device has refused it. place: where
  /// the token is.
  void guard_effectors(Time now, std::string_view place);
  /// When guard_effectors must be called next if nothing else happens; Time::max(): never.
  [[nodiscard]] Time guard_deadline(Time now) const;
  /// Threads: as its members say.
  [[nodiscard]] Effectors& effectors() { return effectors_; }
  [[nodiscard]] const Effectors& effectors() const { return effectors_; }

  void log(LogLevel level, std::string_view text) override;
  void stop(std::string_view reason) override;
  void emergency_stop(std::string_view reason) override;
  void broken(std::string_view assertion) override;
  /// Something has gone wrong in a place of this subsystem: to the terminal and the record.
  void report(Fault fault, std::string_view place, std::string_view what) {
    report(fault, place, what, lane_);
  }
  /// The same from another thread, into that one's lane.
  void report(Fault fault, std::string_view place, std::string_view what, RecordingLane* lane) const;
  /// The transition function of `behaviour` has run longer than the watchdog allows, and has not returned.
  /// Threads: any, with a lane of its own.
  void report_stall(std::uint16_t behaviour, RecordingLane* lane) const;

  void record_death(std::string_view text) const {
    if (lane_ != nullptr)
      lane_->text(Event::Kind::fault, clock_.now(), static_cast<std::uint32_t>(Fault::crash), text);
  }

  [[nodiscard]] const SubsystemParts& parts() const { return parts_; }
  [[nodiscard]] Duration takes(std::uint16_t behaviour) const {
    const Duration declared = parts_.instance->net->behaviours[behaviour].takes;
    return parts_.faulty == nullptr ? declared : declared + parts_.faulty->take_delay();
  }
  [[nodiscard]] bool has_inputs() const { return !inputs_.empty() || !parts_.bindings.real_inputs.empty(); }
  [[nodiscard]] bool commands_devices() const { return !parts_.effectors.empty(); }
  /// Whether a device wants heartbeats, or commands can get stale.
  [[nodiscard]] bool watches_time() const { return commands_devices() || devices_.beats(); }
  [[nodiscard]] bool ended_by_error() const { return erroneous_; }
  [[nodiscard]] std::uint64_t iterations() const { return calls_; }
  [[nodiscard]] std::uint64_t errors() const { return errors_; }

 private:
  void take_changes(Time now);
  void read_receptors(Time now);
  [[nodiscard]] bool read_receptor(std::size_t index, Time now);
  void write_effectors(Time now);
  void fail_late(std::uint64_t missed);
  [[nodiscard]] bool keep_limits(Time now);
  void check_watchdog(Time now);
  void check_outputs();
  void fail_not_finite(const Bindings::Outgoing& output);
  void refresh_ages(Time now);
  void fail_in(Fault fault, std::uint16_t behaviour, std::string_view activity, std::string_view what);
  void fail(Fault fault, std::uint16_t behaviour, std::string_view what);
  [[nodiscard]] std::string_view place_of_call(std::uint16_t behaviour) const;
  void find_received_inputs();
  /// Why the outputs must not go to the devices.
  [[nodiscard]] SafeReason why_hold(Time now) const;
  void hold(const SafeReason& why, std::string_view place);
  void ask_for_operator(std::string_view why);
  void report_hold(const SafeReason& why, std::string_view place);
  void give_safe_command(SafeReason why);
  void try_again(Time now);
  template <class Code>
  [[nodiscard]] bool survives(Fault fault, std::uint16_t behaviour, std::string_view activity, Code&& code);

  SubsystemParts parts_;
  DeviceLife devices_;
  CommandLimits limits_;
  Context& context_;
  RunControl& control_;
  const Clock& clock_;
  RecordingLane* lane_;

  struct InputState {
    Arrival* arrival = nullptr;
    std::uint64_t sequence = 0;  // of the last value read; 0: none yet
    std::uint64_t newest = 0;    // of all values read
    Time last_valid{};
    std::uint32_t source = UINT32_MAX;
    bool known = false;    // a valid value has come
    bool used = false;     // some behaviour receives it
    bool awaited = false;  // one that has been called does
  };
  std::vector<InputState> inputs_;                    // as Bindings::inputs
  std::vector<const Bindings::Outgoing*> checked_;    // outputs that must be finite
  std::vector<std::vector<std::uint32_t>> received_;  // per behaviour: inputs; of effectors only
  Effectors effectors_;
  SafeReason last_safe_{};            // why it was given last
  Time refused_since_ = Time::max();  // the safe command, by some device
  Time called_at_{};
  std::uint64_t iteration_ = 0;  // i of the paper
  std::uint64_t calls_ = 0, errors_ = 0;
  std::uint16_t behaviour_ = 0;  // the last called
  bool failed_ = false;          // the last transition function
  bool erroneous_ = false;       // the last outcome was error
  bool heart_failed_ = false;    // of a device
  SafeReason held_{};            // the safe command stands because of an input
};

}  // namespace tessera
