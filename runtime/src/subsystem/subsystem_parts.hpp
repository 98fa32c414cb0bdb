#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/device_life.hpp"
#include "drivers/driver_watch.hpp"
#include "links/network_end.hpp"
#include "nets/shared_channel.hpp"
#include "parameters/parameter_changes.hpp"
#include "recorder/value_recorder.hpp"
#include "subsystem/call_times.hpp"
#include "subsystem/injection.hpp"
#include "subsystem/overtimes.hpp"
#include "tessera/device.hpp"
#include "tessera/ids.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/tables.hpp"

namespace tessera {

/// One end of a channel, from the side of its subsystem.
struct PortLink {
  SharedChannel* channel = nullptr;
  Side side = Side::send;
  std::uint32_t buffer = 0;   ///< into Bindings::inputs or outputs
  Duration timeout{0};        ///< zero: waits for ever
  InstanceId peer{};          ///< at the other end; none: nobody, or in another process
  NetworkEnd* end = nullptr;  ///< of a channel to another process
  std::string_view remote{};  ///< that process
};

/// The parts of a subsystem besides its net.
struct SubsystemParts {
  std::string path;
  std::uint32_t index = 0;  ///< into System::instances
  const Instance* instance = nullptr;
  CallTimes times{};            ///< in simulated time
  Duration latency{0};          ///< as System
  SharedProcessor processor{};  ///< in real time
  std::unique_ptr<Subsystem> subsystem;
  Bindings bindings;
  std::vector<std::unique_ptr<RealReceptor>> receptors;  ///< as Bindings::real_inputs
  std::vector<std::unique_ptr<RealEffector>> effectors;  ///< as Bindings::real_outputs
  std::vector<DriverInUse> drivers;                      ///< behind receptors and effectors
  std::vector<PortLink> ports;                           ///< as SubsystemNet::ports
  FaultySubsystem* faulty = nullptr;                     ///< `subsystem`, where faults are injected into it
  std::unique_ptr<ValueRecorder> values;                 ///< nullptr: values are not recorded
  ParameterChanges* changes = nullptr;                   ///< nullptr: parameters never change
  bool scripted = false;  ///< a test calls a script in place of its transition functions
};

/// Destroys the drivers, the last one first, so that one whose destructor does not return can be named.
inline void destroy_drivers(SubsystemParts& parts) {
  for (std::size_t index = parts.drivers.size(); index-- > 0;) {
    const DriverInUse& driver = parts.drivers[index];
    const DriverWatch::Call call(DriverWatch::Step::destructor, driver.path);
    for (std::size_t part = driver.first; part < driver.first + driver.count; ++part)
      if (driver.effector)
        parts.effectors[part].reset();
      else
        parts.receptors[part].reset();
  }
}

}  // namespace tessera
