#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tessera/device.hpp"
#include "tessera/main.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/tables.hpp"
#include "tessera/time.hpp"

namespace tessera {

class Substitutes;

/// How a controller is run.
struct RunOptions {
  enum class Clock : std::uint8_t {
    simulated,  ///< single-threaded, deterministic from the seed, as fast as the machine allows
    steady      ///< a thread per subsystem
  } clock = Clock::simulated;
  bool realtime = false;  ///< simulated clock: never faster than the wall clock
  /// Simulated clock: its time is published as /clock of ROS 2 on this network interface, and is never faster
  /// than the wall clock. Empty: it is not published.
  std::string ros2_clock;
  std::optional<Duration> duration;  ///< unset: the run lasts until the net ends or something stops it
  std::uint64_t seed = 1;
  /// Simulated clock: subsystems that can go on at one instant take turns after every firing, not only where
  /// they have to wait. This covers more of the interleavings that threads can have.
  bool interleave = false;
  std::string recording;  ///< path of the file; empty: none
  /// The values of buffers that are recorded.
  enum class Values : std::uint8_t {
    none,
    small,  ///< values of at most small_value bytes; for longer ones, the size and a hash
    all
  } values = Values::small;
  static constexpr std::uint64_t small_value = 4096;
  /// When the file of the recording has `segment_bytes` bytes, the recording goes on in a new file, its
  /// next segment. The newest `segments` files are kept. 0: everything is kept, in one file.
  struct Limit {
    std::uint64_t segment_bytes = 0;
    std::uint32_t segments = 0;
  } record_limit;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< as given by --set PATH=VALUE, in order
  /// Real time: the arguments of ROS 2, as behind `--ros-args` (docs/use/ros2.md); their parameters come after the
  /// others. nullopt: there are none, as in a run that no launch file started.
  std::optional<std::vector<std::string>> ros2_arguments;
  std::vector<DriverRequest> drivers;  ///< of the simulated world; C++ drivers come with the System
  /// Steady clock without a world: uses the simulated C++ drivers of the System in place of the real ones.
  /// Runs with the simulated clock or with a world always do.
  bool simulated_drivers = false;
  /// Hardware in the loop: paths of subsystems and real buffers that use their real drivers in a simulated
  /// run. The simulated clock is then never faster than the wall clock, and the run cannot be paused.
  std::vector<std::string> hardware;
  /// The most that all agents together may use of a resource, as a check of the run.
  struct UseCheck {
    std::string name, resource;
    double most = 0;  ///< in the unit of the resource
  };
  std::vector<UseCheck> use_checks;
  std::optional<WorldOptions> world;
  std::string world_library;  ///< shared library that opens the world
  /// The run can be watched and, in real time, stopped from outside (tessera/monitor.hpp). In real time it
  /// does not start if that is not possible.
  bool monitor = false;
  /// Simulated clock, with `monitor`: the run begins paused.
  bool paused = false;
  /// Simulated clock, with `monitor`: simulated seconds per second of real time. 0: as fast as possible.
  double speed = 1;
  /// Simulated clock, with `monitor`: up to this time the run goes as fast as possible. `speed` and `paused`
  /// apply from then on.
  std::optional<Duration> skip_to;
  /// File of a run that is followed first (tessera verify --scenario). After its last step, the run is free,
  /// and `duration` begins. Simulated clock only.
  std::string scenario;
  std::vector<std::string> inject;  ///< faults to plant, as `--inject` (docs/use/running.md)
  /// How processes of a deployed system communicate (docs/use/fleets.md).
  struct Network {
    std::string process;        ///< steady clock: the process to run; empty: the whole system
    std::string library;        ///< steady clock: the library that carries messages; empty: the installed one
    std::optional<int> domain;  ///< replaces the domain of the System
    std::string interface;      ///< replaces the interface of the process
    std::vector<std::string> peers;  ///< hosts of the other processes; empty: those of the System
    std::optional<std::uint64_t>
        incarnation;         ///< number of this start, greater than all before; unset: the time in ns
    std::string conditions;  ///< simulated clock: as `--network`; empty: the default
  } network;
  /// A subsystem that is stuck for good when the run ends is a warning and not a failure.
  bool accept_stuck = false;
  bool progress = false;  ///< shows the progress in one line on standard error, which is rewritten
  /// File that gets two lines if the process dies during the run: where it was ("robot.control.follow"), and
  /// what happened ("killed by SIGSEGV at address 0x0"). If it dies without notice, and has real devices, both
  /// lines are empty, and a line follows for each device that nothing has made safe. Empty: none.
  std::string death_note;
  /// The folder of the project. Its real devices have one run at a time; empty: any number of runs. also: this
  /// run starts although another one has the devices.
  std::string project;
  bool also = false;
  int parent = 0;  ///< the run ends when this process ends, as with SIGTERM; 0: none
  /// Steady clock: the descriptor of a stream socket through which another process holds the run and lets it go on
  /// (managed/run_orders.hpp). The run begins held, when its devices are open and have their safe commands. -1: none.
  int orders = -1;
  bool guardian = true;  ///< steady clock: a guardian process for drivers that derive from Guarded
  /// Simulated clock: in place of the devices, of a test (tessera/testing.hpp) or of recorded inputs; nullptr: none.
  Substitutes* substitutes = nullptr;
};

/// The times of a chain as a run has measured them; of the chains of a fleet, the longest ones. A command is based on a
/// reading of the first device of the chain.
struct ChainTimes {
  std::string name;
  std::uint64_t members = 0;      ///< chains: the number of agents of a fleet
  std::uint64_t commands = 0;     ///< those that are based on a reading
  std::uint64_t over = 0;         ///< commands at which an age or a reaction exceeded its bound
  std::optional<Duration> age{};  ///< of the last command; nullopt: there is none yet, also for the others
  std::optional<Duration> longest_age{}, reaction{}, longest_reaction{};
  std::optional<Duration> proved_age{}, proved_reaction{};  ///< at most; nullopt: nothing is proved
};

/// The result of a run.
struct RunSummary {
  Duration simulated{};  ///< time on the run's clock
  double wall_s = 0;
  std::uint64_t firings = 0;
  /// "duration", "net ended", "stopped: WHY", or the name of a signal ("SIGINT"). "; stuck for good: ..."
  /// follows if some subsystems can never fire again while others can, and "; robot.motor.left has not taken
  /// its safe command" if a device has not. These are failures.
  std::string ended;
  bool failed = false;  ///< a fault ended the run, or a device has not taken its safe command
  /// Why a run failed, if no fault of a subsystem says so.
  enum class Failure : std::uint8_t {
    none,      ///< it has not failed, or a fault says why
    deadlock,  ///< no event can ever happen again
    stuck,     ///< a subsystem is stuck for good
    scenario,  ///< the scenario could not be followed
    unsafe,    ///< a device has not taken its safe command
    world,     ///< the simulated world failed
    check      ///< it went on to its end, but a check of it failed
  } failure = Failure::none;
  int signal = 0;  ///< the signal that ended the run; 0: none
  /// If a world was slower than real time: the time that the world reached while `simulated` passed.
  std::optional<Duration> world_time;
  struct PerSubsystem {
    std::string path;
    std::uint64_t iterations = 0, overruns = 0, errors = 0;
    std::uint64_t slow_calls = 0, late_wakeups = 0;  ///< longer than `takes`, later than `latency`
    Duration latest_wakeup{0};  ///< the most time until its thread went on after it might
  };
  std::vector<PerSubsystem> subsystems;
  std::vector<ChainTimes> chains;
  /// A behaviour with calls that took longer than declared.
  struct SlowCalls {
    std::string behaviour;  ///< "robot.control.follow"
    std::uint64_t calls = 0, slow = 0;
    Duration declared{0}, longest{0};
    Time longest_at{};  ///< when that one began
  };
  std::vector<SlowCalls> overtime;
  struct PlantedFault {
    std::string text;  ///< as RunOptions::inject
    bool happened = false;
  };
  std::vector<PlantedFault> injected;  ///< the faults planted in this process
  std::string judgement;               ///< checks and measures as World::results; empty: none
  /// The amount of a resource that the behaviours have used, as far as this process ran them.
  struct Used {
    std::string resource, unit;
    double amount = 0;
    std::vector<std::pair<std::string, double>> agents;  ///< those that use it, in the order of the system
  };
  std::vector<Used> used;
  std::uint64_t lost_events = 0;  ///< events missing in the recording
  /// The time at which the recording begins, if its limit has dropped the part before. nullopt: it has its
  /// beginning.
  std::optional<Duration> recorded_from;
  std::uint64_t lines_not_printed = 0;  ///< lines that the terminal did not take
  std::vector<std::string> warnings;    ///< e.g. the recording could not be written
};

/// Builds the system, checks its hash against the net of its tables, and runs it. If it cannot start, the
/// result is nullopt, and `error` says why.
///
/// Threads: one run at a time per process when it handles signals.
[[nodiscard]] std::optional<RunSummary> execute(const System& system, const RunOptions& options,
                                                std::string& error);

}  // namespace tessera
