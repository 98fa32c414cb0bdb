#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tessera/controller.hpp"

namespace tessera {

/// Opens the world of the options' shared library; it stays loaded until the process ends. nullptr without
/// `error`: the options ask for none.
[[nodiscard]] std::unique_ptr<World> open_world(const RunOptions& options, std::string& error);

/// Finds the device behind a real buffer: what the options ask of the world comes before the C++ drivers of
/// the system.
class DeviceFinder {
 public:
  DeviceFinder(const System& system, const RunOptions& options, World* world)
      : system_(system), options_(options), world_(world) {}

  /// nullptr when there is none; `complaints` then says why.
  [[nodiscard]] std::unique_ptr<RealReceptor> receptor(const std::string& path);
  [[nodiscard]] std::unique_ptr<RealEffector> effector(const std::string& path);
  /// One sentence per buffer that got no device and per request that names no real buffer; empty: all is
  /// well.
  [[nodiscard]] std::string complaints() const;

 private:
  template <class Device>
  std::unique_ptr<Device> find(const std::string& path,
                               std::unique_ptr<Device> (World::*from_world)(const DriverRequest&,
                                                                            std::string&),
                               std::unique_ptr<Device> (*CppDriver::*from_cpp)());
  const System& system_;
  const RunOptions& options_;
  World* world_;
  std::vector<std::string> paths_;  // asked for
  std::vector<std::string> complaints_;
};

}  // namespace tessera
