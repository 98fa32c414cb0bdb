#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "chains/age_gauges.hpp"
#include "tessera/tables.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The chain of one member of a fleet, or of no fleet.
struct ChainMember {
  const Chain* chain = nullptr;
  std::uint32_t member = UINT32_MAX;  ///< as ChainWay::member
  AgeGauges gauges{};
};

/// A time that is proved for a chain, and was exceeded.
struct ChainExcess {
  const ChainMember* of = nullptr;
  bool is_reaction = false;  ///< else the age of a command
  Duration measured{0};
};

/// Carries the times of readings through one subsystem, along the chains that it is on. Beside each value in a channel
/// stand the times of the readings that it is based on, one for each way from a device to that channel.
///
/// A call is based on what had been received when it began; a call that fails leaves the outputs as they were, with
/// their readings. Values that a subsystem keeps in its memory do not count. `tessera replay --ages` measures the same
/// (src/replay/times).
///
/// Threads: that of the subsystem. Only the constructor allocates.
class CarriedReadings {
 public:
  static constexpr Time none = Time::min();  ///< no reading

  /// The numbers of readings: 0 is that of the own devices; then come those that arrive.
  struct Layout {
    struct Arrival {
      std::uint32_t port = 0, first = 0, count = 0;
    };
    struct Departure {
      std::uint32_t port = 0;
      std::vector<std::uint32_t> readings;  ///< as they stand in the channel
    };
    struct End {
      std::uint32_t reading = 0;
      ChainMember* member = nullptr;
    };
    std::uint32_t readings = 1;
    std::vector<Arrival> arrivals;
    std::vector<Departure> departures;
    std::vector<End> ends;
    std::vector<ChainMember*> begun;  ///< chains that begin here
  };
  CarriedReadings(const Layout& layout, std::size_t ports);

  void begin_call(Time now) { held_[0] = now; }
  /// The transition function has ended, before its outputs are sent.
  void end_call(bool failed);
  /// carried: beside the value in the channel behind that port.
  void take(std::uint32_t port, const Time* carried) {
    const Span at = arrivals_[port];
    for (std::uint32_t index = 0; index < at.count; ++index) held_[at.first + index] = carried[index];
  }
  void give(std::uint32_t port, Time* carried) const {
    const Span at = departures_[port];
    for (std::uint32_t index = 0; index < at.count; ++index)
      carried[index] = readings_[sources_[at.first + index]];
  }

  /// Whether a chain ends here.
  [[nodiscard]] bool has_ends() const { return !ends_.empty(); }
  /// The call has ended, and the devices have its command if it is `given`. Reports the 1st, 10th, 100th excess of
  /// each chain.
  void end_command(Time now, bool given, bool failed, const std::function<void(const ChainExcess&)>& tell);

 private:
  struct Span {
    std::uint32_t first = 0, count = 0;
  };
  struct End {
    std::uint32_t reading = 0;
    ChainMember* member = nullptr;
    Time reflected = none;  // the newest reading that commands reflect, or would have reflected
  };

  std::vector<Time> held_, readings_;  // of the next call, and of the outputs
  std::vector<Span> arrivals_;         // per port: among the readings
  std::vector<Span> departures_;       // per port: among the sources
  std::vector<std::uint32_t> sources_;
  std::vector<End> ends_;
  std::vector<ChainMember*> begun_;
};

}  // namespace tessera
