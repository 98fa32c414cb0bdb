#pragma once

#include <cstdint>
#include <vector>

#include "drivers/effectors.hpp"
#include "drivers/run_control.hpp"
#include "subsystem/subsystem_parts.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// Transfers values between the buffers of one subsystem and its channels, and knows the ages of the values
/// on its inputs.
///
/// Threads: the subsystem's.
class ChannelValues {
 public:
  ChannelValues(const SubsystemParts& parts, const RunControl& control);

  /// valid: the transition function that has made the value has not failed, and the output was ever written.
  void write(std::uint32_t port, std::uint16_t slot, Time now, bool valid);
  /// An invalid value does not change the buffer, only its status.
  void read(std::uint32_t port, std::uint16_t slot, Time now);
  /// A timeout transition of that port has fired.
  void note_timeout(std::uint32_t port);
  /// A blocking send of that port was acknowledged in time.
  void note_answer(std::uint32_t port);

  /// From now on, commands to devices need a valid value on every input that this behaviour receives.
  void await_inputs(std::uint16_t behaviour);
  /// Sets the ages of the values to those at `now`, and whether other processes are reachable.
  void refresh_ages(Time now);
  /// The transition function has seen every value.
  void mark_seen();

  [[nodiscard]] bool has_inputs() const { return !inputs_.empty(); }
  /// Why the inputs do not allow commands to devices.
  [[nodiscard]] SafeReason why_hold(Time now) const;
  /// When an input gets stale unless a value comes; Time::max(): never. Precondition: `stale` is given.
  [[nodiscard]] Time stale_from() const;

 private:
  struct Input {
    Arrival* arrival = nullptr;
    std::uint64_t sequence = 0;  // of the last value read; 0: none yet
    std::uint64_t newest = 0;    // of all values read
    Time last_valid{};
    InstanceId source{};
    bool given = false;    // a valid value has come
    bool known = false;    // one that allows commands to devices
    bool used = false;     // some behaviour receives it
    bool awaited = false;  // a behaviour that was called receives it
  };
  void find_received_inputs();

  const SubsystemParts& parts_;
  const RunControl& control_;
  std::vector<const PortLink*> remote_;               // to other processes
  std::vector<Input> inputs_;                         // as Bindings::inputs
  std::vector<std::vector<std::uint32_t>> received_;  // per behaviour: inputs; only with effectors
};

}  // namespace tessera
