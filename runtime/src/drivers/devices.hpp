#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/controller.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// Opens the world of the shared library in `options`; the library stays loaded until the process ends.
/// nullptr without `error`: the options ask for no world.
[[nodiscard]] std::unique_ptr<World> open_world(const RunOptions& options, std::string& error);

/// Whether real buffers have the simulated drivers of the system unless the options ask for hardware.
[[nodiscard]] bool simulates_devices(const RunOptions& options);

/// Whether a subsystem or a real buffer has its real driver in such a run.
[[nodiscard]] bool opens_real_driver(const RunOptions& options, std::string_view path);
/// Whether the driver belongs to a subsystem of this system, which may be one process of a larger one.
[[nodiscard]] bool is_of(const System& system, const CppDriver& driver);
/// Whether such a run opens a real device at all.
[[nodiscard]] bool opens_real_devices(const System& system, const RunOptions& options);

/// A driver of a subsystem, and the real buffers that it serves.
struct DriverInUse {
  std::string path;  ///< "robot.motor.left", or "arm.joints"
  Device* device = nullptr;
  std::size_t first = 0, count = 1;  ///< into Bindings::real_inputs or real_outputs
  bool effector = false;             ///< real_outputs
};

/// The devices of one subsystem.
struct SubsystemDevices {
  std::vector<std::unique_ptr<RealReceptor>> receptors;  ///< as Bindings::real_inputs
  std::vector<std::unique_ptr<RealEffector>> effectors;  ///< as Bindings::real_outputs
  std::vector<DriverInUse> drivers;                      ///< the drivers of both, which own them
};

/// Makes the drivers of real buffers. In a simulated run, the devices of the world that the options name
/// come first, then the simulated drivers of the system. A real run, and the hardware in a simulated run,
/// uses the real drivers of the system. No run mixes them otherwise.
class DeviceFinder {
 public:
  DeviceFinder(const System& system, const RunOptions& options, World* world)
      : system_(system), options_(options), world_(world) {}

  /// subsystem: its path. A driver that is not found, or cannot be made, is nullptr; `complaints` says why.
  [[nodiscard]] SubsystemDevices find(const std::string& subsystem, const Bindings& bindings);
  /// One sentence per buffer without a device, and per unknown name.
  [[nodiscard]] std::optional<Problem> complaints() const;
  /// Adds one: a driver that was made does not fit.
  void complain(const Problem& problem) { complaints_.push_back(problem.text); }

 private:
  [[nodiscard]] bool is_hardware(const std::string& path);
  [[nodiscard]] const CppDriver* cpp_driver(const std::string& path, bool hardware) const;
  [[nodiscard]] std::shared_ptr<WorldState> world_for(const CppDriver& driver) const;
  template <class Kind>
  [[nodiscard]] std::unique_ptr<typename Kind::Base> make(const CppDriver& driver);
  template <class Kind>
  [[nodiscard]] std::unique_ptr<typename Kind::Base> find_one(const std::string& path,
                                                              const ValueEncoding* encoding);
  template <class Kind>
  [[nodiscard]] bool find_whole(const std::string& subsystem, const Bindings& bindings,
                                SubsystemDevices& devices);
  template <class Kind>
  void find_all(const std::string& subsystem, const Bindings& bindings, SubsystemDevices& devices);

  const System& system_;
  const RunOptions& options_;
  World* world_;
  std::set<std::string> paths_;     // of subsystems with real buffers, and of real buffers
  std::set<std::string> hardware_;  // names of hardware that were found
  std::vector<std::string> complaints_;
};

}  // namespace tessera
