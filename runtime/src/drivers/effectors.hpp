#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/run_control.hpp"
#include "recorder/recorder.hpp"
#include "system/clock.hpp"
#include "tessera/device.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// The reason for which a device has its safe command.
struct SafeReason {
  enum class Kind : std::uint8_t {
    none,      ///< it does not have it: the last command came from the subsystem
    starting,  ///< no valid value has come to an input yet
    stale,     ///< an input has had no valid value for too long
    source_stalls,
    source_ended,
    fault,      ///< a fault of this subsystem
    stalls,     ///< its own transition function does not return
    stuck,      ///< the subsystem waits for ever
    emergency,  ///< an emergency stop is in force
    suspended,  ///< the process is about to be suspended
    other,      ///< a device of the run does not take its safe command
    leaves      ///< the subsystem or the run ends
  } kind = Kind::none;
  std::string_view input{};  ///< of starting, stale, source_stalls, source_ended; lives as long as the tables
  bool operator==(const SafeReason&) const = default;
};

/// The real effectors of one subsystem: the last command of each, and whether the device took it.
///
/// Each device has a lock, which a thread holds while it calls the driver. So a driver that does not return
/// blocks only the thread that called it. Once the run stops or is suspended (RunControl), only the safe
/// command is sent, whichever thread commands.
///
/// Threads: `command` and `owing` the subsystem's; the others any. Only the constructor allocates.
class Effectors {
 public:
  /// If a device refuses its safe command for longer than this, the run fails.
  static constexpr Duration patience = std::chrono::seconds(1);
  static constexpr Duration between_attempts = std::chrono::milliseconds(5);

  /// A device with its driver, and the outputs that it takes. A bus takes several.
  struct Group {
    std::string name;  ///< "robot.motor.left"
    std::size_t first = 0, count = 1;
  };
  /// drivers: per output.
  Effectors(std::vector<Group> devices, std::span<const std::unique_ptr<RealEffector>> drivers,
            std::span<const Bindings::RealOutgoing> outputs, const RunControl& control, const Clock& clock);

  [[nodiscard]] bool none() const { return drivers_.empty(); }
  enum class Answer : std::uint8_t { taken, refused, withheld };
  /// Sends the outputs, one device after the other, up to the first that refuses. before: the interruptions of
  /// the run when the outputs were found to be good. withheld: the run stops or is interrupted, or was since
  /// then, or was while a driver was called: the safe command must follow.
  /// Passes on what a driver throws.
  [[nodiscard]] Answer command(Time now, const RunControl::Interruptions& before);
  /// The device that has refused a command last.
  [[nodiscard]] std::string_view refuser() const { return refuser_; }

  enum class Busy : std::uint8_t { waits, leaves_out };
  /// Gives all devices the safe command, once. A driver that throws has refused. true: all devices have
  /// taken it. busy: what to do about a device that another thread calls at the moment.
  bool make_safe(SafeReason why, Busy busy);
  /// The same, only for devices that have not taken their safe command.
  bool insist(SafeReason why, Busy busy);

  // For a thread that serves one device, because a driver may not return.
  /// As make_safe. If `busy` is `leaves_out`, a device that another thread calls has not taken it.
  bool make_safe_one(std::size_t index, SafeReason why, Busy busy);
  [[nodiscard]] bool owes(std::size_t index) const { return devices_[index].owes; }
  /// The device has been in use for so long that it counts as one that does not take its safe command.
  void note_resistance(std::size_t index);
  /// The devices that do not take their safe command at present: they have refused it, or their driver does not
  /// return. Wakes the supervisor when there is another one (RunControl::tell_supervisor).
  [[nodiscard]] bool resists() const;
  /// Since when the subsystem's thread has been giving the present safe commands, by the monotonic clock; 0: it does
  /// not. Wakes the supervisor when safe commands begin, because a driver may not return from one.
  [[nodiscard]] std::int64_t giving_since_ns() const { return giving_since_ns_; }
  [[nodiscard]] std::vector<std::string> resisting() const;
  [[nodiscard]] const std::string& name(std::size_t index) const { return devices_[index].its.name; }

  /// Calls code while no other thread calls the driver of that output. Threads: the subsystem's.
  void alone_with(std::size_t output, const std::function<void()>& code);

  [[nodiscard]] bool is_safe(std::size_t index) const {
    return devices_[index].safe && !devices_[index].owes;
  }

  // The following members are for a thread that acts because another one dies (Rescuer).
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] const void* device(std::size_t index) const { return &devices_[index]; }
  /// The device whose driver the calling thread is calling; nullptr: none. Async-signal-safe.
  [[nodiscard]] static const void* device_in_call();
  /// Gives one device the safe command, once, if no thread calls its driver, or only the dying one, for
  /// which device_in_call has returned `dead`. A driver that throws has refused.
  [[nodiscard]] bool rescue(std::size_t index, const void* dead);

  /// Whether the last request was the safe command and some device has not taken it.
  [[nodiscard]] bool owing() const;
  /// The devices whose last command was not the safe one, or may not have been, as "robot.motor.left".
  [[nodiscard]] std::vector<std::string> unsafe() const;

  /// The devices that have not taken their safe command since the present emergency stop began. A device that
  /// is not named has it, and gets nothing else until the stop ends. Call it while the stop stands.
  [[nodiscard]] std::vector<std::string> not_stopped();

  /// Records the changes since the last call: which devices got the safe command and why, which got other
  /// commands again, and which refused. Leaves out devices that another thread calls at the moment. lane:
  /// the calling thread's; nullptr: nothing is recorded.
  void record(RecordingLane* lane);

 private:
  struct Device {
    Group its{};
    std::atomic_flag in_use{};
    std::atomic<bool> owes{false};             // the safe command
    std::atomic<bool> safe{false};             // the last accepted command was the safe one
    std::atomic<bool> resists{false};          // it owes the safe command, and has refused it or is stuck
    std::atomic<std::uint32_t> stopped_in{0};  // the last emergency stop in which it took the safe one
    SafeReason standing{}, recorded{};
    Time since{};             // since when `standing` is the reason
    bool refused = false;     // the last safe command was refused
    bool complained = false;  // the refusal has been recorded
  };
  class Lock;
  [[nodiscard]] std::span<Device> devices() const { return {devices_.get(), count_}; }
  [[nodiscard]] bool write(Device& device, Time now);
  [[nodiscard]] bool write_safe(Device& device, SafeReason why);
  [[nodiscard]] bool is_stopped(Device& device) const;
  void note_resistance(Device& device) const;
  bool make_safe(SafeReason why, Busy busy, bool owing_only);
  static void record(Device& device, RecordingLane& lane);

  std::span<const std::unique_ptr<RealEffector>> drivers_;
  std::span<const Bindings::RealOutgoing> outputs_;
  const RunControl& control_;
  const Clock& clock_;
  std::size_t count_;
  std::unique_ptr<Device[]> devices_;
  std::string_view refuser_;
  std::atomic<std::int64_t> giving_since_ns_{0};
  SafeReason::Kind told_ = SafeReason::Kind::none;  // to the supervisor; the subsystem's thread
};

/// "robot.motor.left has not taken its safe command". Precondition: there are names.
[[nodiscard]] std::string not_safe(const std::vector<std::string>& names);

/// "no valid value has come to input 'velocity' yet"
[[nodiscard]] std::string_view describe(const SafeReason& why, std::span<char> room);

}  // namespace tessera
