#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drivers/devices.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The life of the drivers of one subsystem (tessera/device.hpp): opened, beating, closed.
///
/// Threads: `open` and `close` the run's, the rest the subsystem's.
class DeviceLife {
 public:
  explicit DeviceLife(std::vector<DriverInUse> drivers);

  /// secure: gives the buffers of a driver that has just been opened their safe command. false: a device
  /// could not be opened or secured, `error` says which; what was opened has to be closed.
  [[nodiscard]] bool open(const std::function<bool(const DriverInUse&)>& secure, std::string& error);
  /// Closes what is open, the last first. Returns what went wrong.
  std::vector<std::string> close();
  /// Whether some driver wants heartbeats.
  [[nodiscard]] bool beats() const { return !beating_.empty(); }
  /// When `beat` must be called next; Time::max(): never.
  [[nodiscard]] Time next_beat() const;
  /// How a driver is called, so that nobody else calls it meanwhile.
  using Around = std::function<void(const DriverInUse&, const std::function<void()>&)>;
  /// Calls the heartbeat of every driver for which it is due. What a driver throws gets out, after which its
  /// next beat is a period later.
  void beat(Time now, const Around& around);

 private:
  struct Beating {
    const DriverInUse* driver;
    Duration period;
    Time next{};
  };
  [[nodiscard]] static std::string opened(const DriverInUse& driver);

  std::vector<DriverInUse> drivers_;
  std::vector<Beating> beating_;
  std::size_t open_ = 0;  // so many are, from the first on
};

}  // namespace tessera
