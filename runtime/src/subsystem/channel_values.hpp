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
  /// Whether the last read over that port has taken a new and valid value.
  [[nodiscard]] bool took(std::uint32_t port) const { return inputs_[parts_.ports[port].buffer].taken_fresh; }
  /// A timeout transition of that port has fired.
  void note_timeout(std::uint32_t port);
  /// A blocking send of that port was acknowledged in time.
  void note_answer(std::uint32_t port);

  /// The net knows that value of a fact from now on (Does::Kind::know).
  void learn(std::uint16_t fact, std::uint16_t value);
  /// While it lives, `fresh` of an input whose outcome the net knows says how its last receive ended, for
  /// conditions; otherwise it says whether the value is new since the last transition function.
  class OutcomesShown {
   public:
    explicit OutcomesShown(ChannelValues& values);
    OutcomesShown(const OutcomesShown&) = delete;
    OutcomesShown& operator=(const OutcomesShown&) = delete;
    ~OutcomesShown();

   private:
    ChannelValues& values_;
  };

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
    bool given = false;        // a valid value has come
    bool known = false;        // one that allows commands to devices
    bool used = false;         // some behaviour receives it
    bool awaited = false;      // a behaviour that was called receives it
    bool taken_fresh = false;  // the last value taken was new and valid
  };
  /// The outcome of the last receive of an input; without arrival: of no input.
  struct Outcome {
    Arrival* arrival = nullptr;
    std::uint32_t input = 0;
    bool fresh = false;
  };
  void find_received_inputs();

  const SubsystemParts& parts_;
  const RunControl& control_;
  std::vector<const PortLink*> remote_;               // to other processes
  std::vector<Input> inputs_;                         // as Bindings::inputs
  std::vector<Outcome> outcomes_;                     // per fact of the net
  std::vector<std::vector<std::uint32_t>> received_;  // per behaviour: inputs; only with effectors
};

}  // namespace tessera
