#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "tessera/time.hpp"

namespace tessera {

/// A real receptor R: read before every transition function of its virtual receptor.
class RealReceptor {
 public:
  virtual ~RealReceptor() = default;
  /// Fills `value` (the bytes of the real buffer's type, or where an object of it is if it is more than
  /// bytes). false: no value now; the buffer keeps the old one, not fresh.
  [[nodiscard]] virtual bool read(std::span<std::byte> value) = 0;
};

/// A real effector E: written after every transition function of its virtual effector, and with the safe
/// command.
class RealEffector {
 public:
  virtual ~RealEffector() = default;
  /// false: the device refused; the subsystem's error.
  [[nodiscard]] virtual bool write(std::span<const std::byte> value) = 0;
};

/// A device behind a real buffer, as specifications and command lines name it.
struct DriverRequest {
  std::string path;                       ///< "robot.sensor.left"
  std::string kind;                       ///< "reflectance"
  std::string target;                     ///< "eye_left"
  std::map<std::string, double> options;  ///< e.g. {"noise", 0.01}
};

struct WorldOptions {
  std::string world;  ///< MJCF file
  std::string track;  ///< PNG of the floor, dark is line; empty: a white floor
  double metres_per_pixel = 0.005;
  std::optional<double> start_x_m, start_y_m, start_heading_rad;  ///< unset: as the world file says
  double footprint_m = 0.008;                                     ///< diameter of what a light sensor sees
  std::uint64_t seed = 1;                                         ///< of sensor noise
  std::string trace;  ///< file that gets the path driven; empty: none
};

/// A simulated world: makes devices, and moves in lock-step with the clock.
///
/// Threads: advance_to and the devices it made may be called from different threads (the world locks).
class World {
 public:
  virtual ~World() = default;
  /// nullptr and `error` when the world has no such thing.
  [[nodiscard]] virtual std::unique_ptr<RealReceptor> receptor(const DriverRequest& request,
                                                               std::string& error) = 0;
  [[nodiscard]] virtual std::unique_ptr<RealEffector> effector(const DriverRequest& request,
                                                               std::string& error) = 0;
  /// Physics up to `time`; deterministic. Never goes back.
  virtual void advance_to(Time time) = 0;
  /// Writes out the trace. false and `error` when that failed.
  [[nodiscard]] virtual bool finish(std::string& error) = 0;
};

/// What the world's shared library exports as `tessera_open_world`.
using OpenWorld = std::unique_ptr<World> (*)(const WorldOptions& options, std::string& error);

/// A device written by the user in C++ (`cpp: Class`): derive from Receptor<T> or Effector<T>.
template <class T>
class Receptor : public RealReceptor {
 public:
  /// nullopt: no value now. An exception is the subsystem's error.
  virtual std::optional<T> read() = 0;
  [[nodiscard]] bool read(std::span<std::byte> value) final {
    const std::optional<T> now = read();
    if (!now) return false;
    if constexpr (std::is_trivially_copyable_v<T>)
      std::copy_n(reinterpret_cast<const std::byte*>(&*now), sizeof(T), value.data());
    else
      *reinterpret_cast<T*>(value.data()) = *now;
    return true;
  }
};
template <class T>
class Effector : public RealEffector {
 public:
  /// false: the device refused.
  virtual bool write(const T& value) = 0;
  [[nodiscard]] bool write(std::span<const std::byte> bytes) final {
    if constexpr (std::is_trivially_copyable_v<T>) {
      T value;
      std::copy_n(bytes.data(), sizeof(T), reinterpret_cast<std::byte*>(&value));
      return write(value);
    } else {
      return write(*reinterpret_cast<const T*>(bytes.data()));
    }
  }
};

}  // namespace tessera
