#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/coppelia/link_error.hpp"
#include "sim/coppelia/simulator.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::coppelia {

/// A scene of CoppeliaSim that moves in lock-step with the clock of the run. A world and its devices share
/// it.
///
/// * The simulation starts with the first advance, and makes one step before the run's time zero, with the
///  safe commands. So every sensor of the scene has a value from the beginning.
/// * Commands are sent before the next step. So a reading is the state of its instant, whoever reads first.
/// * After a failure, no further request is sent.
///
/// Threads: all members lock.
class LockStep {
 public:
  /// Connects and loads the scene. It first stops a simulation that a killed run has left. Errors: LinkError;
  /// RefusedCall; also LinkError if another simulation is running.
  explicit LockStep(const WorldServer& server);
  LockStep(const LockStep&) = delete;
  LockStep& operator=(const LockStep&) = delete;
  /// See finish.
  ~LockStep();

  void advance_to(Time time);
  [[nodiscard]] Duration time() const;
  /// Sends the last commands, stops the simulation, and closes the scene if it was loaded. Problem: the
  /// simulation has failed, now or before.
  [[nodiscard]] std::optional<Problem> finish();

  /// Calls `use(simulator)` with exclusive access, and returns its result. Throws std::runtime_error once the
  /// simulation has failed.
  template <class Use>
  auto use(Use&& use) {
    const std::scoped_lock lock(mutex_);
    throw_failure();
    try {
      return std::forward<Use>(use)(simulator_);
    } catch (const LinkError& error) {
      failure_ = Problem{error.what()};
      throw;
    }
  }

  /// The object at `path` with the agent's name before it ("/robot[3]/eye"), otherwise at `path` itself. A
  /// path that begins with `/` never gets the agent's name. Errors: see `use`.
  [[nodiscard]] std::optional<Object> find(const std::string& agent, const std::string& path);

  /// The command is sent before the next step.
  void command(const Object& joint, JointCommand how, double value);

 private:
  struct Command {
    Object joint;
    JointCommand how = JointCommand::none;
    double value = 0;
  };
  void end_abandoned(const std::string& place);
  void start();
  void step();
  void send_commands();
  void end();
  void throw_failure() const;

  mutable std::mutex mutex_;
  Simulator simulator_;
  bool is_loaded_ = false;
  bool is_running_ = false;
  bool is_finished_ = false;
  Duration step_{};
  Duration time_{};         // time of the run
  std::int64_t steps_ = 0;  // since the run's time zero
  double start_s_ = 0;      // the time of the simulation at the run's time zero
  std::vector<Command> commands_;
  std::map<std::string, std::optional<Object>> found_;
  std::optional<Problem> failure_;
};

}  // namespace tessera::coppelia
