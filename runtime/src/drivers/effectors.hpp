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

/// Why the safe command stands at a device.
struct SafeReason {
  enum class Kind : std::uint8_t {
    none,      ///< it does not: the last command was one of the subsystem's
    starting,  ///< no valid value has come to an input yet
    stale,     ///< an input has had no valid value for too long
    source_stalls,
    source_ended,
    fault,      ///< of this subsystem
    stalls,     ///< its own transition function does not return
    stuck,      ///< it waits for ever
    emergency,  ///< an emergency stop stands
    suspended,  ///< the process is about to stop for a while
    leaves      ///< the subsystem or the run ends
  } kind = Kind::none;
  std::string_view input{};  ///< of starting, stale, source_stalls, source_ended; lives as long as the tables
  bool operator==(const SafeReason&) const = default;
};

/// The real effectors of one subsystem: what was commanded last, and whether they took it.
///
/// A device has one lock, which its thread holds while the driver is called: a driver that does not return
/// holds up nobody but the thread that called it. Once the run stops or is suspended (RunControl), no command
/// but the safe one goes out, whoever gives it.
///
/// Threads: `command` and `owing` the subsystem's; the others any. Nothing but the constructor allocates.
class Effectors {
 public:
  /// A device that refuses its safe command for so long makes the run fail.
  static constexpr Duration patience = std::chrono::seconds(1);
  static constexpr Duration between_attempts = std::chrono::milliseconds(5);

  /// A device with its driver, and which outputs it takes: a bus takes several.
  struct Group {
    std::string name;  ///< "robot.motor.left"
    std::size_t first = 0, count = 1;
  };
  /// drivers: per output.
  Effectors(std::vector<Group> devices, std::span<const std::unique_ptr<RealEffector>> drivers,
            std::span<const Bindings::RealOutgoing> outputs, const RunControl& control, const Clock& clock);

  [[nodiscard]] bool none() const { return drivers_.empty(); }
  enum class Answer : std::uint8_t { taken, refused, withheld };
  /// Sends the outputs, one device after the other, up to the first that refuses. withheld: the run stops.
  /// Throws what a driver throws.
  [[nodiscard]] Answer command(Time now);

  enum class Busy : std::uint8_t { waits, leaves_out };
  /// Gives every device the safe command, once; what a driver throws is a refusal. true: all have taken it.
  /// busy: what to do about a device that another thread calls at the moment.
  bool make_safe(SafeReason why, Busy busy);
  /// The same for those only that have not taken theirs.
  bool insist(SafeReason why, Busy busy);

  /// Calls code while nobody else calls the driver that takes that output. Threads: the subsystem's.
  void alone_with(std::size_t output, const std::function<void()>& code);

  // For a thread that acts because another one dies (Rescuer).
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] const void* device(std::size_t index) const { return &devices_[index]; }
  /// The device whose driver the calling thread is in; nullptr: none. Async-signal-safe.
  [[nodiscard]] static const void* device_in_call();
  /// Gives one device the safe command, once, if no thread is in its driver, or only the dying one, for which
  /// device_in_call has given `dead`. What the driver throws is a refusal.
  [[nodiscard]] bool rescue(std::size_t index, const void* dead);

  /// The safe command was wanted last, and some device has not taken it.
  [[nodiscard]] bool owing() const;
  /// Devices whose last command taken is not the safe one, as "robot.motor.left".
  [[nodiscard]] std::vector<std::string> unsafe() const;

  /// Writes what has changed since it was called last: to which devices the safe command was given and why,
  /// where it ended, and who refused it. Leaves out devices that another thread calls at the moment.
  /// lane: the calling thread's; nullptr: nothing is recorded.
  void record(RecordingLane* lane);

 private:
  struct Device {
    Group its{};
    std::atomic_flag in_use{};
    std::atomic<bool> owes{false};  // the safe command
    std::atomic<bool> safe{false};  // the last command taken was the safe one
    SafeReason standing{}, recorded{};
    Time since{};             // standing
    bool refused = false;     // the last safe command
    bool complained = false;  // that is recorded
  };
  class Lock;
  [[nodiscard]] std::span<Device> devices() const { return {devices_.get(), count_}; }
  [[nodiscard]] bool write(Device& device, Time now);
  [[nodiscard]] bool write_safe(Device& device, SafeReason why);
  bool make_safe(SafeReason why, Busy busy, bool owing_only);
  static void record(Device& device, RecordingLane& lane);

  std::span<const std::unique_ptr<RealEffector>> drivers_;
  std::span<const Bindings::RealOutgoing> outputs_;
  const RunControl& control_;
  const Clock& clock_;
  std::size_t count_;
  std::unique_ptr<Device[]> devices_;
};

/// "no valid value has come to input 'velocity' yet"
[[nodiscard]] std::string_view describe(const SafeReason& why, std::span<char> room);

}  // namespace tessera
