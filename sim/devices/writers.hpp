#pragma once

#include <map>
#include <mutex>
#include <span>
#include <string>

#include "tessera/device.hpp"

namespace tessera::sim {

/// The devices that write the elements of a world: each element has one. Two writers would undo each
/// other's commands at every step.
///
/// Threads: any.
class Writers {
 public:
  /// Something of the world that a device writes.
  struct Element {
    std::string identity;  ///< the same for every name of it
    std::string text;      ///< "actuator 'left'"
    std::string name;      ///< as the driver calls it
  };
  /// Takes the elements for the device of the request, which may ask again. Throws DeviceError if an element
  /// has another writer, or stands twice in the list.
  void claim(const DriverRequest& request, std::span<const Element> elements);

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> writers_;  ///< identity -> path of the real buffer
};

}  // namespace tessera::sim
