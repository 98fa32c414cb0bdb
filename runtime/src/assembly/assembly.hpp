#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chains/followed_chains.hpp"
#include "drivers/devices.hpp"
#include "drivers/panel.hpp"
#include "drivers/run_control.hpp"
#include "links/links.hpp"
#include "links/simulated_network.hpp"
#include "nets/flat_net.hpp"
#include "nets/process_part.hpp"
#include "nets/shared_channel.hpp"
#include "parameters/parameter_changes.hpp"
#include "recorder/pose_recorder.hpp"
#include "recorder/recorder.hpp"
#include "subsystem/injection.hpp"
#include "subsystem/scenario.hpp"
#include "subsystem/subsystem_executor.hpp"
#include "system/clock.hpp"
#include "tessera/controller.hpp"
#include "tessera/device.hpp"

namespace tessera {

class Guardian;

/// Makes the subsystems of a process again, for a new start of it. No state of the old ones remains.
class ProcessRestarts {
 public:
  virtual ~ProcessRestarts() = default;
  /// The process has died: its ends of channels become inactive. Its executors remain readable.
  virtual void kill(std::uint32_t process) = 0;
  /// Precondition: it was killed, and its devices are closed. The new executors replace the old ones, and
  /// their devices are open. false and `error`: a device cannot be made or opened.
  [[nodiscard]] virtual bool restart(std::uint32_t process, network::Incarnation incarnation,
                                     std::string& error) = 0;
};

/// A controller ready to run: every subsystem with its plan, channels, devices and parameters.
struct Assembly {
  Assembly(const System& its_system, const RunOptions& its_options)
      : Assembly(all_of(its_system), its_options) {}
  Assembly(ProcessPart its_part, const RunOptions& its_options)
      : part(std::move(its_part)),
        system(part.system),
        options(its_options),
        chains(part),
        control(static_cast<std::uint32_t>(part.system.instances.size())) {}
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  /// nullptr: nothing is recorded.
  [[nodiscard]] RecordingLane* system_lane() const {
    return recorder == nullptr ? nullptr : recorder->system_lane();
  }

  const ProcessPart part;
  const System& system;  ///< of the part
  const RunOptions& options;
  FollowedChains chains;
  RunControl control;
  Guardian* guardian = nullptr;  ///< nullptr: none
  RunTally* tally = nullptr;     ///< counts what is not recorded; nullptr: nothing does
  std::unique_ptr<World> world;
  std::vector<WorldFailure> failed_checks;  ///< of the world, so far
  std::size_t recorded_checks = 0;          ///< how many of them are recorded
  std::string judgement;                    ///< World::results, at the end
  std::unique_ptr<Recorder> recorder;
  std::unique_ptr<PoseRecorder> poses;  ///< nullptr: there is no world, or it has no picture
  std::string scene_file;               ///< of the world; empty: none
  std::optional<Scenario> scenario;
  Injections faults;
  InjectedSignals signals;
  Panels panels;                              ///< of operators, behind real buffers
  std::unique_ptr<ParameterChanges> changes;  ///< made with the executors, which take them
  /// The words of a channel: one; of a channel between processes, one per end in this process.
  struct Words {
    std::unique_ptr<SharedChannel> of_sender, of_receiver;
    [[nodiscard]] std::uint16_t marking() const;  ///< as far as this process knows it. Threads: any
    std::uint16_t receivers = 0;                  ///< fused places that only the receiver's word knows
  };
  std::vector<Words> channels;                ///< per channel; the word of a local one is the sender's
  std::unique_ptr<network::Carrier> carrier;  ///< steady clock: of messages to other processes; nullptr: none
  std::unique_ptr<SimulatedNetwork> network;  ///< simulated clock: the same
  std::unique_ptr<Links> links;               ///< nullptr: there is no channel to another process
  network::Incarnation incarnation{1};        ///< of this start of the process
  std::vector<Outage> outages;                ///< simulated clock: when processes die, in this order
  std::unique_ptr<ProcessRestarts> restarts;  ///< nullptr: none dies
  std::vector<Words> dead_channels;           ///< of processes that have died; still readable
  std::vector<std::unique_ptr<SubsystemExecutor>> dead;       ///< of processes that have begun again
  std::vector<std::unique_ptr<SubsystemExecutor>> executors;  ///< per instance; devices die before the world
};

/// Checks that the tables are the verified net, and makes all parts.
///
/// Errors: other tables version, names that do not resolve, another hash, unknown or bad parameters, real
///         buffers without a driver, a network that cannot be opened, a value without a fixed size on a channel
///         to another process, a world, recording or scenario that cannot be opened: false and `error`.
[[nodiscard]] bool assemble(Assembly& assembly, const Clock& clock, Waker& waker, std::string& error);

/// A subsystem by itself.
struct LoosePart {
  SubsystemParts parts;  ///< each port has a channel of its own; no devices
  std::shared_ptr<const Plan> plan;
  std::uint32_t first_transition = 0;  ///< the number of its plan's first transition in recordings
};
struct LooseParts {
  std::vector<std::unique_ptr<SharedChannel>> channels;
  std::vector<LoosePart> parts;  ///< per instance
};

/// Makes the subsystems one by one, so that user code runs without the system around it.
///
/// Errors: as assemble.
[[nodiscard]] bool take_apart(Assembly& assembly, const Clock& clock, LooseParts& parts, std::string& error);

}  // namespace tessera
