#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tessera/device.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// The parts with which a test replaces parts of a system, when a run makes them.
///
/// Threads: the one that starts the run.
class Substitutes {
 public:
  Substitutes() = default;
  Substitutes(const Substitutes&) = delete;
  Substitutes& operator=(const Substitutes&) = delete;
  virtual ~Substitutes() = default;

  /// instance: into System::instances. scripted: set to whether a script of the test is called in place of its
  /// transition functions.
  [[nodiscard]] virtual std::unique_ptr<Subsystem> subsystem(std::uint32_t instance,
                                                             std::unique_ptr<Subsystem> own,
                                                             bool& scripted) = 0;
  /// The receptor for the real buffer at that path.
  [[nodiscard]] virtual std::unique_ptr<RealReceptor> receptor(const std::string& path) = 0;
  [[nodiscard]] virtual std::unique_ptr<RealEffector> effector(const std::string& path) = 0;
};

}  // namespace tessera
