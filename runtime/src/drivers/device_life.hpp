#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/devices.hpp"
#include "tessera/result.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The life of the drivers of one subsystem (tessera/device.hpp): open, heartbeats, close.
///
/// Threads: `open` and `close` the run's, the rest the subsystem's.
class DeviceLife {
 public:
  explicit DeviceLife(std::vector<DriverInUse> drivers);

  /// secure: gives the buffers of a driver that has just been opened their safe command; it may throw.
  /// false: a device could not be opened or secured, and `error` says which. Devices that were opened have
  /// to be closed.
  [[nodiscard]] bool open(const std::function<bool(const DriverInUse&)>& secure, std::string& error);
  /// Closes the open devices, the last one first. Returns the failures.
  std::vector<std::string> close();
  /// Whether a driver needs heartbeats.
  [[nodiscard]] bool beats() const { return !beating_.empty(); }
  /// The paths of those drivers.
  [[nodiscard]] std::vector<std::string> with_heartbeat() const;
  /// When `beat` must be called next; Time::max(): never.
  [[nodiscard]] Time next_beat() const;
  /// Calls a driver in such a way that no other thread calls it at the same time.
  using Around = std::function<void(const DriverInUse&, const std::function<void()>&)>;
  /// Calls the heartbeat of every driver for which it is due. Passes on what a driver throws; the next
  /// heartbeat of that driver is a period later.
  void beat(Time now, const Around& around);

 private:
  struct Beating {
    const DriverInUse* driver;
    Duration period;
    Time next{};
  };

  std::vector<DriverInUse> drivers_;
  std::vector<Beating> beating_;
  std::size_t open_ = 0;  // number of open drivers, from the first one on
};

}  // namespace tessera
