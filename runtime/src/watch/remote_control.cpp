#include "watch/remote_control.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

namespace tessera {
namespace {

constexpr double fastest = 1000;

}  // namespace

RemoteControl::RemoteControl(Assembly& assembly, bool paused, double speed)
    : assembly_(assembly),
      paused_(paused),
      stands_(paused),
      speed_(speed),
      news_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  update();
}

RemoteControl::~RemoteControl() { close(news_); }

// -------------------------------------------------------------------------------------------- the watcher's

std::optional<Problem> RemoteControl::execute(const SimulationCommand& command) {
  const std::lock_guard lock(mutex_);
  std::optional<Problem> wrong = std::visit([this](const auto& one) { return this->apply(one); }, command);
  if (wrong) return wrong;
  update();
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(news_, &one, sizeof one);
  return std::nullopt;
}

std::optional<Problem> RemoteControl::apply(const command::Pause& /*command*/) {
  set_paused(true);
  return std::nullopt;
}

std::optional<Problem> RemoteControl::apply(const command::Resume& /*command*/) {
  set_paused(false);
  return std::nullopt;
}

void RemoteControl::set_paused(bool paused) {
  paused_ = paused;
  firings_left_ = 0;
  to_iteration_ = false;
  broke_at_.clear();
}

std::optional<Problem> RemoteControl::apply(const command::StepFiring& /*command*/) {
  paused_ = true;
  ++firings_left_;
  return std::nullopt;
}

std::optional<Problem> RemoteControl::apply(const command::StepIteration& command) {
  InstanceId found;
  for (std::uint32_t instance = 0; instance < assembly_.executors.size(); ++instance)
    if (assembly_.executors[instance]->path() == command.subsystem) found = {instance};
  if (!command.subsystem.empty() && !found.valid())
    return Problem{"there is no subsystem '" + command.subsystem + "'"};
  paused_ = true;
  to_iteration_ = true;
  iterating_ = found;
  iterations_.clear();
  return std::nullopt;
}

std::optional<Problem> RemoteControl::apply(const command::Speed& command) {
  if (!std::isfinite(command.value) || command.value < 0 || command.value > fastest)
    return Problem{"a speed is a number from 0 (as fast as possible) to 1000"};
  speed_ = command.value;
  return std::nullopt;
}

std::optional<Problem> RemoteControl::apply(const command::Breakpoints& command) {
  using When = Breakpoint::When;
  std::vector<Breakpoint> wanted;
  if (assembly_.recorder == nullptr && !command.transitions.empty())
    return Problem{"a breakpoint on a transition needs a run that is recorded"};
  for (const auto& [names, when] :
       {std::pair{&command.places, When::marked}, std::pair{&command.transitions, When::fires},
        std::pair{&command.conditions, When::enabled}})
    for (const std::string& name : *names) {
      Breakpoint one{.when = when, .name = name};
      if (!find(one))
        return Problem{std::string("no subsystem or channel of the controller has the ") +
                       (when == When::marked ? "place '" : "transition '") + one.name + "'"};
      wanted.push_back(std::move(one));
    }
  breakpoints_ = std::move(wanted);
  return std::nullopt;
}

bool RemoteControl::find(Breakpoint& breakpoint) const {
  const std::string& name = breakpoint.name;
  const auto is_in = [&](const auto& elements, std::string_view owner) {
    for (breakpoint.index = 0; breakpoint.index < elements.size(); ++breakpoint.index) {
      const std::string_view local = elements[breakpoint.index].name;
      if (name.size() == owner.size() + 1 + local.size() && name.starts_with(owner) &&
          name[owner.size()] == '.' && name.ends_with(local))
        return true;
    }
    return false;
  };
  const bool is_place = breakpoint.when == Breakpoint::When::marked;
  for (const InstanceId instance : Ids<InstanceId>(assembly_.executors.size())) {
    breakpoint.instance = instance;
    const SubsystemNet& net = *assembly_.system.instances[instance.value].net;
    const std::string& owner = assembly_.executors[instance.value]->path();
    if (is_place ? is_in(net.places, owner) : is_in(net.transitions, owner)) return true;
  }
  breakpoint.instance = {};
  for (const ChannelId id : Ids<ChannelId>(is_place ? assembly_.system.channels.size() : 0)) {
    breakpoint.channel = id;
    const Channel& channel = assembly_.system.channels[id.value];
    if (is_in(channel.places, channel.name)) return true;
  }
  return false;
}

Snapshot::Control RemoteControl::shown() const {
  const std::lock_guard lock(mutex_);
  return {.paused = stands_ && resting(), .pauses = pauses_, .speed = speed_, .broke_at = broke_at_};
}

void RemoteControl::abandon() {
  assembly_.control.request_stop("the process that started it has ended", /*fault=*/false);
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(news_, &one, sizeof one);
}

// -------------------------------------------------------------------------------------------- the run's

void RemoteControl::pause() {
  const std::lock_guard lock(mutex_);
  set_paused(true);
  update();
}

void RemoteControl::update() { one_by_one_ = paused_ || !breakpoints_.empty(); }

void RemoteControl::take_news() const {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t taken = read(news_, &count, sizeof count);
}

bool RemoteControl::wait_while_paused(const StopSignals& signals) {
  bool waited = false;
  while (StopSignals::pending() == 0 && !assembly_.control.stopping()) {
    {
      const std::lock_guard lock(mutex_);
      stands_ = resting();
      if (!stands_) return waited;
      if (!waited) {
        ++pauses_;
        if (assembly_.recorder != nullptr) assembly_.recorder->flush();
      }
    }
    std::array<pollfd, 2> sources{pollfd{.fd = news_, .events = POLLIN, .revents = 0},
                                  pollfd{.fd = signals.descriptor(), .events = POLLIN, .revents = 0}};
    poll(sources.data(), sources.size(), -1);
    take_news();
    waited = true;
  }
  const std::lock_guard lock(mutex_);
  stands_ = false;
  return waited;
}

bool RemoteControl::wait_for(Duration time, const StopSignals& signals) {
  std::array<pollfd, 2> sources{pollfd{.fd = news_, .events = POLLIN, .revents = 0},
                                pollfd{.fd = signals.descriptor(), .events = POLLIN, .revents = 0}};
  const timespec left{.tv_sec = time.count() / 1'000'000'000, .tv_nsec = time.count() % 1'000'000'000};
  const bool interrupted = ppoll(sources.data(), sources.size(), &left, nullptr) > 0;
  take_news();
  return !interrupted;
}

bool RemoteControl::holds(const Breakpoint& breakpoint) const {
  if (breakpoint.when == Breakpoint::When::enabled)
    return assembly_.executors[breakpoint.instance.value]->wants_to_fire(breakpoint.index);
  if (breakpoint.instance.valid())
    return assembly_.executors[breakpoint.instance.value]->holds(breakpoint.index);
  return (assembly_.channels[breakpoint.channel.value].marking() >> breakpoint.index & 1U) != 0;
}

void RemoteControl::about_to_fire() {
  const std::lock_guard lock(mutex_);
  if (to_iteration_ && iterations_.empty())
    for (const auto& executor : assembly_.executors)
      iterations_.push_back(executor->operations().iterations());
  for (Breakpoint& one : breakpoints_) {
    if (one.when == Breakpoint::When::fires || std::exchange(one.known, true)) continue;
    one.held = holds(one);
  }
}

/// Pauses if the breakpoint's condition holds now, or if its transition has just fired.
void RemoteControl::look_at(Breakpoint& breakpoint, std::uint32_t fired) {
  bool reached = false;
  if (breakpoint.when == Breakpoint::When::fires) {
    reached =
        breakpoint.instance.value == fired && assembly_.executors[fired]->last_fired() == breakpoint.index;
  } else {
    const bool holds_now = holds(breakpoint);
    reached = holds_now && !breakpoint.held;
    breakpoint.held = holds_now;
    breakpoint.known = true;
  }
  if (!reached) return;
  paused_ = true;
  firings_left_ = 0;
  to_iteration_ = false;
  broke_at_ = breakpoint.name;
}

void RemoteControl::fired(std::uint32_t instance) {
  const std::lock_guard lock(mutex_);
  if (firings_left_ > 0) --firings_left_;
  const bool counts = !iterating_.valid() || iterating_.value == instance;
  if (to_iteration_ && !iterations_.empty() && counts &&
      assembly_.executors[instance]->operations().iterations() > iterations_.at(instance))
    to_iteration_ = false;
  for (Breakpoint& one : breakpoints_) look_at(one, instance);
  update();
}

void RemoteControl::keep_recording_live() {
  if (!recording_wanted_.load(std::memory_order_relaxed)) return;
  recording_wanted_.store(false, std::memory_order_relaxed);
  if (assembly_.recorder != nullptr) assembly_.recorder->flush();
}

}  // namespace tessera
