#include "sim/coppelia/lock_step.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "sim/coppelia/link_error.hpp"
#include "sim/coppelia/run_mark.hpp"

namespace tessera::coppelia {

LockStep::LockStep(const WorldServer& server) : simulator_(server) {
  if (!simulator_.is_stopped()) end_abandoned(server.host + ":" + std::to_string(server.port));
  if (!server.scene.empty()) simulator_.load(server.scene);
  is_loaded_ = !server.scene.empty();
  try {
    simulator_.require_main_script();
    step_ = simulator_.time_step();
  } catch (...) {
    static_cast<void>(finish());  // no destructor closes the loaded scene
    throw;
  }
}

/// Stops a simulation that a killed run has left. Errors: LinkError if another program may need it.
void LockStep::end_abandoned(const std::string& place) {
  std::optional<RunMark> mark;
  try {
    mark = mark_of(simulator_.mark());
  } catch (const RefusedCall&) {  // the mark is unreadable
  }
  if (!mark)
    throw LinkError("a simulation runs already in CoppeliaSim at " + place + "; stop it there first");
  const Owner owner = owner_of(*mark);
  if (owner != Owner::has_gone)
    throw LinkError("another run of Tessera simulates in CoppeliaSim at " + place + ": process " +
                    std::to_string(mark->process) +
                    (owner == Owner::on_another_machine ? " on " + mark->host +
                                                              ". If it was killed, begin "
                                                              "the next run there"
                                                        : "; end it first"));
  simulator_.stop();
  if (mark->has_loaded) simulator_.close_scene();
  std::fprintf(
      stderr,
      "tessera: note: a run that was killed (process %lld) had left a simulation in CoppeliaSim at %s; "
      "it has been stopped\n",
      static_cast<long long>(mark->process), place.c_str());
}

LockStep::~LockStep() { static_cast<void>(finish()); }

void LockStep::advance_to(Time time) {
  const std::scoped_lock lock(mutex_);
  if (failure_ || is_finished_) return;
  try {
    if (!is_running_) start();
    while (time_ + step_ <= time.time_since_epoch()) {
      step();
      time_ += step_;
    }
  } catch (const std::exception& error) {
    failure_ = Problem{error.what()};
  }
}

/// A step that is requested before the simulation has really begun has no effect.
void LockStep::start() {
  constexpr int most_tries = 10;
  simulator_.start_stepping();
  is_running_ = true;
  send_commands();
  for (int tries = 0; tries < most_tries && start_s_ == 0; ++tries) {
    simulator_.step();
    start_s_ = simulator_.time_s();
  }
  if (start_s_ == 0) throw LinkError("the simulation does not begin in CoppeliaSim");
  try {
    simulator_.set_mark(text_of(mark_of_this_process(is_loaded_)));
  } catch (const RefusedCall&) {  // without a mark, a killed run leaves the simulation to the user
  }
}

void LockStep::step() {
  send_commands();
  simulator_.step();
  ++steps_;
  const double expected_s = start_s_ + seconds(step_) * static_cast<double>(steps_);
  const double time_s = simulator_.time_s();
  if (std::abs(time_s - expected_s) < seconds(step_) / 2) return;
  // A simulation that another program stops still makes some steps, without waiting for its clients.
  const bool is_ended = time_s < expected_s || !simulator_.goes_on();
  throw LinkError(is_ended
                      ? "the simulation has been paused or stopped in CoppeliaSim"
                      : "the simulation has gone on by itself: CoppeliaSim was not asked for a minute, or "
                        "another client steps it, too");
}

void LockStep::send_commands() {
  const std::vector<Command> commands = std::exchange(commands_, {});
  for (const Command& one : commands) simulator_.command(one.joint, one.how, one.value);
}

Duration LockStep::time() const {
  const std::scoped_lock lock(mutex_);
  return time_;
}

/// Tries to stop the simulation even after a failure: CoppeliaSim may only have been busy for too long.
void LockStep::end() {
  constexpr Duration patience = std::chrono::seconds(2);
  if (simulator_.is_lost()) simulator_.connect_again(patience);
  if (is_running_ && !failure_) send_commands();
  if (is_running_) simulator_.stop();
  if (is_loaded_) simulator_.close_scene();
}

std::optional<Problem> LockStep::finish() {
  const std::scoped_lock lock(mutex_);
  if (!std::exchange(is_finished_, true)) {
    try {
      end();
    } catch (const std::exception& error) {
      if (!failure_) failure_ = Problem{error.what()};
    }
  }
  return failure_;
}

std::optional<Object> LockStep::find(const std::string& agent, const std::string& path) {
  return use([&](Simulator& simulator) {
    const bool is_absolute = path.starts_with('/');
    const std::string absolute = is_absolute ? path : "/" + path;
    const std::string own = "/" + agent + absolute;
    for (const std::string& one : is_absolute ? std::vector{absolute} : std::vector{own, absolute}) {
      const auto [entry, is_new] = found_.try_emplace(one);
      if (is_new) entry->second = simulator.find(one);
      if (entry->second) return entry->second;
    }
    return std::optional<Object>();
  });
}

void LockStep::command(const Object& joint, JointCommand how, double value) {
  const std::scoped_lock lock(mutex_);
  throw_failure();
  std::erase_if(commands_, [&](const Command& one) { return one.joint.handle == joint.handle; });
  commands_.push_back({joint, how, value});
}

void LockStep::throw_failure() const {
  if (failure_) throw std::runtime_error(failure_->text);
}

}  // namespace tessera::coppelia
