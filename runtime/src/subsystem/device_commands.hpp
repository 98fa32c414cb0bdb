#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/command_limits.hpp"
#include "drivers/device_life.hpp"
#include "drivers/effectors.hpp"
#include "drivers/run_control.hpp"
#include "recorder/recorder.hpp"
#include "subsystem/channel_values.hpp"
#include "subsystem/reports.hpp"
#include "subsystem/subsystem_parts.hpp"
#include "system/clock.hpp"

namespace tessera {

/// Gives the devices of one subsystem their commands and heartbeats.
///
/// *Safe command.* It is given instead of the outputs
/// - until a valid value has come to every input that the behaviours called so far receive;
/// - while no valid value has arrived on some input for longer than `stale` (counted from the start of the
///   run before the first value; an invalid value does not count);
/// - during an emergency stop;
/// - while a subsystem that feeds an input stalls, and for good once one has ended.
/// It is given at once on failure, and by `leave` whenever the run ends. It is given first and reported
/// afterwards. If a device refuses it, it is given again; if the device refuses for longer than
/// Effectors::patience, the run fails.
///
/// Threads: that of the subsystem, unless said otherwise.
class DeviceCommands {
 public:
  /// All of these must outlive it. inputs: of the same subsystem.
  DeviceCommands(const SubsystemParts& parts, const ChannelValues& inputs, const Reports& reports,
                 RunControl& control, const Clock& clock, RecordingLane* lane);

  /// Opens the devices; an effector gets its safe command as soon as its device is open. false and `error`:
  /// one could not be opened or refuses; what is open must still be closed. Threads: before the run.
  [[nodiscard]] bool open(std::string& error);
  /// Closes the open devices and returns what went wrong. Threads: after the run.
  std::vector<std::string> close() { return life_.close(); }

  /// Whether there is no real effector.
  [[nodiscard]] bool none() const { return effectors_.none(); }
  /// Whether a device wants heartbeats, or commands can get stale.
  [[nodiscard]] bool watches_time() const { return !none() || life_.beats(); }
  /// The drivers that want heartbeats, once they are open.
  [[nodiscard]] std::vector<std::string> with_heartbeat() const { return life_.with_heartbeat(); }
  /// Threads: as its members say.
  [[nodiscard]] Effectors& effectors() { return effectors_; }
  [[nodiscard]] const Effectors& effectors() const { return effectors_; }

  /// Why the outputs were not sent as commands.
  struct Failure {
    Fault fault;
    std::string_view what;  ///< text in the given room, or a constant
  };
  /// Sends the outputs, or gives the safe command where they must not go to the devices. place: where the
  /// token is. nullopt: done. Throws what a driver throws.
  [[nodiscard]] std::optional<Failure> send(Time now, std::string_view place, std::span<char> room);
  /// Whether the devices have taken what `send` sent last.
  [[nodiscard]] bool have_command() const { return have_command_; }
  /// Gives the safe command because of a fault, which has not been reported yet.
  void make_safe_after_fault() { give_safe_command({SafeReason::Kind::fault}); }
  /// The fault has been reported. Begins an emergency stop if only an operator may end the safe command.
  void note_fault(std::string_view what);

  /// Calls the heartbeats that are due. place: where the token is.
  void beat(Time now, std::string_view place);
  /// When `beat` must be called next; Time::max(): no device wants heartbeats.
  [[nodiscard]] Time next_beat() const { return life_.next_beat(); }
  /// Gives the safe command because the subsystem or the run ends.
  void leave() { give_safe_command({SafeReason::Kind::leaves}); }
  /// Gives the safe command again to devices that have not accepted it, for as long as Effectors::patience.
  void insist();
  /// Calls heartbeats that are due. Gives the safe command if an input is stale, or its source has ended or
  /// stalls, unless it was already given for that reason. Gives it again to a device that has refused it.
  /// place: where the token is.
  void guard(Time now, std::string_view place);
  /// When `guard` must be called next if nothing else happens; Time::max(): never.
  [[nodiscard]] Time guard_deadline(Time now) const;

 private:
  [[nodiscard]] Failure refusal(std::span<char> room) const;
  [[nodiscard]] std::optional<Failure> keep_limits(Time now, std::span<char> room);
  [[nodiscard]] SafeReason::Kind why_withheld(const RunControl::Interruptions& before) const;
  [[nodiscard]] SafeReason why_hold(Time now) const;
  void hold(const SafeReason& why, std::string_view place);
  void report_hold(const SafeReason& why, std::string_view place);
  void ask_for_operator(std::string_view why);
  void give_safe_command(SafeReason why);
  void try_again(Time now);

  const SubsystemParts& parts_;
  const ChannelValues& inputs_;
  const Reports& reports_;
  RunControl& control_;
  const Clock& clock_;
  RecordingLane* lane_;
  DeviceLife life_;
  CommandLimits limits_;
  Effectors effectors_;
  SafeReason last_safe_{};            // why it was given last
  bool has_commanded_ = false;        // a device has taken a command of the transition function
  bool have_command_ = false;         // the devices have taken the last one
  SafeReason held_{};                 // the safe command stands because of an input
  Time refused_since_ = Time::max();  // since when some device refuses the safe command
  bool heart_failed_ = false;         // the heartbeat of a device has failed
};

}  // namespace tessera
