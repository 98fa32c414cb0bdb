#include "run/steady_run.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <iterator>
#include <optional>
#include <utility>

#include "drivers/effectors.hpp"
#include "run/steady_links.hpp"
#include "run/world_checks.hpp"
#include "safety/death.hpp"
#include "system/console.hpp"
#include "system/realtime.hpp"
#include "system/thread_role.hpp"
#include "watch/boundary.hpp"
#include "watch/liveness.hpp"
#include "watch/stillness.hpp"
#include "watch/watchdogs.hpp"

namespace tessera {
namespace {

constexpr Duration world_step = std::chrono::milliseconds(1);
// A stop may have to wait for one step of the world.
constexpr Duration longest_world_step = std::chrono::milliseconds(10);
// A slow world makes up for at most this delay.
constexpr Duration most_behind = std::chrono::milliseconds(200);
constexpr Duration progress_step = std::chrono::milliseconds(200);
// A safe command that takes longer may never end: another thread takes care of the other devices.
constexpr Duration longest_safe_command = std::chrono::milliseconds(40);

}  // namespace

SteadyRun::SteadyRun(std::uint32_t instances, const GiveUp& give_up)
    : give_up_(give_up),
      wake_words_(std::make_unique<WakeWord[]>(instances)),
      gone_(std::make_unique<std::atomic<bool>[]>(instances)),
      collected_(instances),
      stuck_(instances),
      news_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

SteadyRun::~SteadyRun() {
  if (news_ >= 0) close(news_);
}

void SteadyRun::tell_supervisor() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(news_, &one, sizeof one);
}

void SteadyRun::run_subsystem(SubsystemExecutor& executor, std::uint32_t instance, RunControl& control) {
  // However this thread ends (user code may call pthread_exit), it leaves its devices safe.
  struct Leaving {
    SteadyRun& run;
    SubsystemExecutor& executor;
    std::uint32_t instance;
    RunControl& control;
    bool orderly = false;
    ~Leaving() {
      if (!orderly) complain_of_ended_thread(executor, control);
      if (control.stopping()) run.tell_supervisor();  // now, because the devices may take long
      if (!control.has_ended(instance)) executor.leave();
      executor.insist();
      if (!control.stopping() && executor.effectors().owing())
        control.request_stop(not_safe(executor.effectors().unsafe()), /*fault=*/true);
      run.gone_[instance].store(true, std::memory_order_release);
      run.tell_supervisor();
    }
  } leaving{*this, executor, instance, control};
  const AlternateStack stack;
  survives_in_thread(control, executor.path(), [&] {
    // Makes releases as exact as the timer allows. By default, the kernel may add 50 us to save a wake-up.
    prctl(PR_SET_TIMERSLACK, 1UL);
    const Instance& its = *executor.operations().parts().instance;
    if (const auto denied = schedule_this_thread(its.policies.realtime)) deny(*denied);
    executor.enter_thread();
    step_until_end(executor, wake_words_[instance], control);
  });
  leaving.orderly = true;
}

void SteadyRun::step_until_end(SubsystemExecutor& executor, WakeWord& wakes,
                               const RunControl& control) const {
  while (!control.stopping()) {
    const std::uint32_t ticket = wakes.ticket();
    if (control.paused()) {
      wakes.sleep(ticket, -1);
      continue;
    }
    const SubsystemExecutor::Progress progress = executor.step();
    if (progress.state == SubsystemExecutor::State::ready) continue;
    if (progress.state != SubsystemExecutor::State::waiting) break;
    const std::uint32_t changes = clock_.changes();
    const std::int64_t might_ns = sleep(executor, wakes, ticket, progress, control);
    if (might_ns >= 0 && changes == clock_.changes() && !control.paused() && !control.stopping())
      executor.note_wakeup(Duration(std::max<std::int64_t>(monotonic_ns() - might_ns, 0)));
  }
}

/// Sleeps until there may be work. Heartbeats are not part of the net: a subsystem that only sends heartbeats
/// is at rest (Stillness). Returns the moment of CLOCK_MONOTONIC at which the thread might go on; negative: it did not
/// sleep, or that is not known.
std::int64_t SteadyRun::sleep(SubsystemExecutor& executor, WakeWord& wakes, std::uint32_t ticket,
                              const SubsystemExecutor::Progress& progress, const RunControl& control) const {
  const auto limit = [&](Time time) { return time == Time::max() ? -1 : clock_.absolute_ns(time); };
  if (progress.deadline != Time::max() || progress.beat == Time::max())
    return wakes.sleep(ticket, limit(std::min(progress.deadline, progress.beat)));
  Time beat = progress.beat;
  for (bool again = false; !wakes.rest_until(ticket, limit(beat), again); again = true) {
    if (control.paused()) return -1;
    beat = executor.beat(clock_.now());
  }
  return -1;
}

/// One warning per run, because a thousand threads may be denied the same.
void SteadyRun::deny(const Problem& what) {
  if (denied_.exchange(true, std::memory_order_relaxed)) return;
  console::print(LogLevel::warning, clock_.now(), "tessera",
                 fmt::format("not in real time, as the specification asks ({}); give the permission with "
                             "CAP_SYS_NICE and CAP_IPC_LOCK, or limits rtprio and memlock",
                             what.text));
}

/// A world that is slower than real time falls behind. It moves in short steps, so that no thread waits
/// long for it. The delay that it cannot make up for is left out (Ending::world_time).
void SteadyRun::run_world(Assembly& assembly) {
  World& world = *assembly.world;
  RunControl& control = assembly.control;
  const AlternateStack stack;
  const bool survived = survives_in_thread(control, "the world", [&] {
    Duration left_out{};
    for (Time next{}; !control.stopping();) {
      const std::uint32_t ticket = world_wakes_.ticket();
      if (control.paused()) {
        world_wakes_.sleep(ticket, -1);
        next = {};
        continue;
      }
      const Time now = clock_.now();
      left_out += std::max(now - left_out - world_time_ - most_behind, Duration::zero());
      if (left_out > Duration::zero()) say_world_is_slow();
      world_time_ = std::min(now - left_out, world_time_ + longest_world_step);
      world.advance_to(world_time_);
      notice_failed_checks(assembly);
      if (world_time_ + longest_world_step < clock_.now() - left_out) continue;  // the world catches up
      next = std::max(next, clock_.now()) + world_step;
      if (!control.stopping()) world_wakes_.sleep(ticket, clock_.absolute_ns(next));
    }
  });
  if (!survived) tell_supervisor();
}

void SteadyRun::run_links(Assembly& assembly) {
  const AlternateStack stack;
  if (!survives_in_thread(assembly.control, "the network",
                          [&] { serve_links_until_end(assembly, clock_, net_ended_); }))
    tell_supervisor();
}

void SteadyRun::say_world_is_slow() {
  if (std::exchange(world_is_slow_, true)) return;
  console::print(LogLevel::warning, clock_.now(), "tessera",
                 "the simulated world is slower than real time: its time falls behind that of the run");
}

Ending SteadyRun::run(Assembly& assembly, UpperLayers& upper, const StopSignals& /*signals*/) {
  if (wants_realtime(assembly.system.instances))
    if (const std::optional<Problem> denied = lock_memory()) deny(*denied);
  clock_.restart();
  if (assembly.links != nullptr) assembly.links->set_origin(clock_.absolute_ns(Time{}));
  assembly.control.set_supervisor_event(news_);
  if (const int signal = StopSignals::pending(); signal != 0)
    assembly.control.request_stop(StopSignals::name(signal), /*fault=*/false);
  upper.enter(clock_.now());
  for (const auto& executor : assembly.executors) executor->enter();
  if (assembly.options.orders >= 0) {
    orders_.emplace(assembly.options.orders);
    stand_still(assembly.control);
  }
  {
    const RealTimePriority priority(supervisor_priority(assembly.system.instances));
    if (priority.denied()) deny(*priority.denied());
    Securing& securing =
        securing_.emplace(assembly.executors, priority.priority(), [this] { tell_supervisor(); });
    survives_in_thread(assembly.control, "no thread for every subsystem", [&] { start_threads(assembly); });
    survives_in_thread(assembly.control, "the supervisor", [&] { supervise(assembly, upper, securing); });
    move_on();
    orders_.reset();  // nobody reads it from now on
    wake_all(assembly);
    while (
        !survives_in_thread(assembly.control, "the supervisor", [&] { await_threads(assembly, securing); }))
      continue;
    end_threads(assembly, securing);
  }
  collect_ended(assembly, upper);
  return ending(assembly, upper);
}

std::optional<Problem> SteadyRun::listen(const Assembly& assembly) {
  if (!assembly.options.monitor) return std::nullopt;
  listening_ = Monitor::listen(assembly);
  return listening_->failure();
}

/// The monitor comes first: an emergency stop that came while the devices were opened is in force before a subsystem
/// can send a command.
void SteadyRun::start_threads(Assembly& assembly) {
  if (listening_ != nullptr) {
    monitor_.emplace(assembly, clock_, std::move(listening_));
    if (const std::optional<Problem>& failure = monitor_->failure())
      assembly.control.request_stop("the run cannot be stopped from outside: " + failure->text,
                                    /*fault=*/true);
  }
  threads_.reserve(assembly.executors.size());
  if (assembly.links != nullptr) beside_.emplace_back([this, &assembly] { run_links(assembly); });
  if (assembly.world != nullptr) beside_.emplace_back([this, &assembly] { run_world(assembly); });
  for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance) {
    threads_.emplace_back([this, &assembly, instance] {
      run_subsystem(*assembly.executors[instance], instance, assembly.control);
    });
    ++started_;
  }
  if (monitor_ && assembly.carrier != nullptr) status_.emplace(assembly, clock_);
  shown_ = ShownInRos2::of(assembly, clock_);
}

void SteadyRun::supervise(Assembly& assembly, UpperLayers& upper, Securing& securing) {
  const Time end = assembly.options.duration ? Time(*assembly.options.duration) : Time::max();
  ProgressLine progress(assembly.options.progress, assembly.options.duration);
  RunControl& control = assembly.control;
  RecordingLane* const lane = assembly.system_lane();
  Watchdogs watchdogs(
      assembly.executors,
      [&](std::uint32_t instance) { securing.secure(instance, {SafeReason::Kind::stalls}); }, lane);
  Stillness stillness(started_);
  Liveness& liveness = liveness_.emplace(assembly, assembly.guardian);
  EmergencyWatch emergencies;
  const auto gone = [&](std::uint32_t instance) { return gone_[instance].load(std::memory_order_acquire); };
  while (!control.stopping()) {
    collect_ended(assembly, upper);
    collect_secured(control, securing, lane);
    follow_emergency(emergencies, control, securing, lane);
    const Time now = clock_.now();
    const Time safe_commands = follow_safe_commands(assembly, securing, now);
    const Time beat = show_life();
    if (control.stopping())
      break;  // whatever else is asked: the guardian has acted, or a device does not obey
    if (upper.ended()) {
      net_ended_.store(true, std::memory_order_release);
      control.request_stop("net ended", /*fault=*/false);
    } else if (const int signal = StopSignals::pending(); signal != 0) {
      control.request_stop(StopSignals::name(signal), /*fault=*/false);
    } else if (StopSignals::suspension_asked()) {
      liveness.suspend();
      suspend(assembly, securing);
      liveness.resume();
    } else if (asked_to_hold(control)) {
      hold(assembly, securing, emergencies);
    } else if (now >= end) {
      duration_over_ = true;
      control.request_stop("duration", /*fault=*/false);
    } else if (stillness.look(now, wake_words_.get(), gone) && !waits_for_network(assembly)) {
      control.request_stop(why_nothing_happens(assembly), /*fault=*/true);
    } else {
      if (stillness.changed()) look_for_stuck(assembly, stillness, securing, now);
      progress.update(now);
      assembly.signals.raise_due(now);
      // Watchdogs come first, so that their findings are reported.
      const Time watched = watchdogs.check(now);
      const Time next = std::min({end, stillness.next(), watched, assembly.signals.next(),
                                  securing.overdue_from(now), beat, safe_commands});
      await_news(assembly.options.progress ? std::min(next, now + progress_step) : next);
    }
  }
}

/// Secures the devices first: a subsystem whose user code runs long does not check by itself.
void SteadyRun::follow_emergency(EmergencyWatch& emergencies, const RunControl& control, Securing& securing,
                                 RecordingLane* lane) const {
  using News = EmergencyWatch::News;
  for (News news = emergencies.look(control); news != News::none; news = emergencies.look(control)) {
    if (news == News::begins)
      for (std::uint32_t instance = 0; instance < started_; ++instance)
        securing.secure(instance, {SafeReason::Kind::emergency});
    EmergencyWatch::say(news, control, clock_.now(), lane);
  }
}

/// If a device does not take its safe command, its state is unknown. So the other devices keep their safe
/// commands until it has taken its own, or until the run stops for that reason. Returns when to look again.
Time SteadyRun::follow_safe_commands(Assembly& assembly, Securing& securing, Time now) {
  Time next = Time::max();
  bool any = false;
  securing.note_resistance();
  for (std::uint32_t instance = 0; instance < started_; ++instance) {
    const Effectors& effectors = assembly.executors[instance]->effectors();
    any = any || effectors.resists();
    const std::int64_t since_ns = effectors.giving_since_ns();
    if (since_ns == 0) continue;
    const Duration lasts(monotonic_ns() - since_ns);
    if (lasts >= longest_safe_command) securing.secure(instance, {SafeReason::Kind::stalls});
    next = std::min(next, now + std::max(longest_safe_command - lasts, Effectors::between_attempts));
  }
  RunControl& control = assembly.control;
  if (any && !control.holds_devices()) {
    control.hold_devices(true);
    hold_the_others(assembly, securing, now);
  } else if (!any && control.holds_devices()) {
    control.hold_devices(false);
  }
  return any ? std::min(next, now + Effectors::between_attempts) : next;
}

void SteadyRun::hold_the_others(const Assembly& assembly, Securing& securing, Time now) {
  constexpr Duration between_messages = std::chrono::seconds(1);  // a device may resist again and again
  std::vector<std::string> resisting;
  for (std::uint32_t instance = 0; instance < started_; ++instance) {
    const Effectors& effectors = assembly.executors[instance]->effectors();
    if (!effectors.resists()) securing.secure(instance, {SafeReason::Kind::other});
    std::ranges::move(effectors.resisting(), std::back_inserter(resisting));
  }
  if (resisting.empty() || (told_of_resistance_ && now < *told_of_resistance_ + between_messages)) return;
  told_of_resistance_ = now;
  console::print(LogLevel::warning, now, "tessera",
                 not_safe(resisting) + "; until then the other devices have theirs");
}

/// A device that does not take its safe command ends the run, if its own subsystem cannot report it.
void SteadyRun::collect_secured(RunControl& control, Securing& securing, RecordingLane* lane) {
  if (const std::vector<std::string> devices = securing.refusing(); !devices.empty())
    control.request_stop(not_safe(devices), /*fault=*/true);
  securing.collect(lane);
}

void SteadyRun::look_for_stuck(Assembly& assembly, const Stillness& stillness, Securing& securing, Time now) {
  const std::vector<std::uint32_t> stuck = stuck_among_resting(assembly, stillness.resting());
  if (stuck.empty() || !stillness.rest_still(wake_words_.get(), stuck)) return;
  stuck_.found(assembly, stuck, now,
               [&](std::uint32_t instance) { securing.secure(instance, {SafeReason::Kind::stuck}); });
}

void SteadyRun::collect_ended(const Assembly& assembly, UpperLayers& upper) {
  for (std::uint32_t instance = 0; instance < collected_.size(); ++instance) {
    if (collected_[instance] || !assembly.control.has_ended(instance)) continue;
    collected_[instance] = true;
    upper.subsystem_ended(instance, clock_.now());
  }
}

/// Waits for news of a subsystem, or of a thread that secures devices, or for a signal.
void SteadyRun::await_news(Time until) const {
  // poll ignores a negative descriptor
  const int orders = orders_ ? orders_->descriptor() : -1;
  std::array<pollfd, 3> sources{pollfd{.fd = news_, .events = POLLIN, .revents = 0},
                                pollfd{.fd = StopSignals::descriptor(), .events = POLLIN, .revents = 0},
                                pollfd{.fd = orders, .events = POLLIN, .revents = 0}};
  const Duration left = std::max(until - clock_.now(), Duration::zero());
  const timespec limit{.tv_sec = left.count() / 1'000'000'000, .tv_nsec = left.count() % 1'000'000'000};
  ppoll(sources.data(), sources.size(), until == Time::max() ? nullptr : &limit, nullptr);
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t taken = read(news_, &count, sizeof count);
  StopSignals::take_news();
}

void SteadyRun::wake_all(const Assembly& assembly) {
  world_wakes_.wake();
  if (assembly.links != nullptr) assembly.links->wake(0);
  for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance)
    wake_words_[instance].wake();
}

}  // namespace tessera
