#pragma once

#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/controller.hpp"

namespace tessera {

/// Opens the world of the options' shared library; it stays loaded until the process ends. nullptr without
/// `error`: the options ask for none.
[[nodiscard]] std::unique_ptr<World> open_world(const RunOptions& options, std::string& error);

/// Whether the simulated drivers of the system stand behind its real buffers, where no hardware is asked for.
[[nodiscard]] bool simulates_devices(const RunOptions& options);

/// Whether the real driver stands behind a subsystem or a real buffer in such a run.
[[nodiscard]] bool opens_real_driver(const RunOptions& options, std::string_view path);

/// A driver of a subsystem, and which of the real buffers it serves.
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
  std::vector<DriverInUse> drivers;                      ///< behind them, owned by them
};

/// Makes the drivers behind real buffers. A simulated run gets simulated ones: what the options ask of the
/// world, then the simulated drivers of the system. A real one (and the hardware in a simulated run) gets the
/// real drivers of the system. Neither ever gets the others.
class DeviceFinder {
 public:
  DeviceFinder(const System& system, const RunOptions& options, World* world)
      : system_(system), options_(options), world_(world) {}

  /// subsystem: its path. What it cannot find, or what cannot be made, is nullptr; `complaints` then says
  /// why.
  [[nodiscard]] SubsystemDevices find(const std::string& subsystem, const Bindings& bindings);
  /// One sentence per buffer that got no device and per name that is none; empty: all is well.
  [[nodiscard]] std::string complaints() const;

 private:
  [[nodiscard]] bool is_hardware(const std::string& path);
  [[nodiscard]] const CppDriver* cpp_driver(const std::string& path, bool hardware) const;
  template <class Kind>
  [[nodiscard]] std::unique_ptr<typename Kind::Base> make(const CppDriver& driver);
  template <class Kind>
  [[nodiscard]] std::unique_ptr<typename Kind::Base> find_one(const std::string& path);
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
