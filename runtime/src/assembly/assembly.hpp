#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/devices.hpp"
#include "drivers/run_control.hpp"
#include "nets/flat_net.hpp"
#include "nets/shared_channel.hpp"
#include "recorder/pose_recorder.hpp"
#include "recorder/recorder.hpp"
#include "subsystem/injection.hpp"
#include "subsystem/parameter_changes.hpp"
#include "subsystem/scenario.hpp"
#include "subsystem/subsystem_executor.hpp"
#include "system/clock.hpp"
#include "tessera/controller.hpp"

namespace tessera {

class Guardian;

/// A controller ready to run: every subsystem with its plan, channels, devices and parameters.
struct Assembly {
  Assembly(const System& its_system, const RunOptions& its_options)
      : system(its_system),
        options(its_options),
        control(static_cast<std::uint32_t>(its_system.instances.size())) {}

  const System& system;
  const RunOptions& options;
  RunControl control;
  Guardian* guardian = nullptr;  ///< nullptr: none
  RunTally* tally = nullptr;     ///< counts what is not recorded; nullptr: nothing does
  std::unique_ptr<World> world;
  std::vector<WorldFailure> failed_checks;  ///< of the world, so far
  std::size_t recorded_checks = 0;          ///< how many of them are recorded
  std::string judgement;                    ///< World::results, at the end
  std::unique_ptr<Recorder> recorder;
  std::unique_ptr<PoseRecorder> poses;  ///< nullptr: there is no world, or it cannot be looked at
  std::string scene_file;               ///< of the world; empty: none
  std::optional<Scenario> scenario;
  Injections faults;
  InjectedSignals signals;
  std::unique_ptr<ParameterChanges> changes;  ///< made with the executors, which take them
  std::vector<std::unique_ptr<SharedChannel>> channels;
  std::vector<std::unique_ptr<SubsystemExecutor>> executors;  ///< per instance; devices die before the world
};

/// Checks that the tables are the net that was verified, and puts everything together.
///
/// Errors: other tables version, names that do not resolve, another hash, unknown or bad parameters, real
///         buffers without a driver, a world, recording or scenario that cannot be opened: false and `error`.
[[nodiscard]] bool assemble(Assembly& assembly, const Clock& clock, Waker& waker, std::string& error);

/// A subsystem by itself.
struct LoosePart {
  SubsystemParts parts;  ///< each port has a channel of its own; no devices
  std::shared_ptr<const Plan> plan;
  std::uint32_t first_transition = 0;  ///< how recordings number those of its plan
};
struct LooseParts {
  std::vector<std::unique_ptr<SharedChannel>> channels;
  std::vector<LoosePart> parts;  ///< per instance
};

/// Puts the subsystems together one by one, for user code to be run without the system around it.
///
/// Errors: as assemble.
[[nodiscard]] bool take_apart(Assembly& assembly, const Clock& clock, LooseParts& parts, std::string& error);

}  // namespace tessera
