#include "run/simulated_run.hpp"

#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "run/world_checks.hpp"
#include "system/console.hpp"
#include "watch/boundary.hpp"
#include "watch/stillness.hpp"

namespace tessera {
namespace {

using Failure = RunSummary::Failure;

/// Keeps simulated time from running ahead of real time. A signal or a command ends the wait.
class Pace {
 public:
  /// hardware: lost time is not made up for, so simulated time is never faster than real time.
  Pace(bool realtime, bool hardware, RemoteControl* remote, const StopSignals& signals)
      : speed_(realtime || hardware ? 1 : 0), hardware_(hardware), remote_(remote), signals_(signals) {}

  /// Counts time from here again, after a pause or a change of speed.
  void restart(Time now) {
    start_ = now;
    start_ns_ = monotonic_ns();
  }

  /// false: it is not time yet.
  [[nodiscard]] bool wait_for(Time time, Time now, Recorder* recorder) {
    if (remote_ != nullptr && remote_->speed() != speed_) {
      speed_ = remote_->speed();
      restart(now);
    }
    if (speed_ <= 0) return true;
    const auto after_ns = static_cast<std::int64_t>(static_cast<double>((time - start_).count()) / speed_);
    const std::int64_t left_ns = start_ns_ + after_ns - monotonic_ns();
    if (left_ns <= 0) {
      if (hardware_) restart(time);
      return true;
    }
    if (recorder != nullptr) recorder->flush();  // there is time for it, and an observer sees the events
    if (remote_ != nullptr) return remote_->wait_for(Duration(left_ns), signals_);
    timespec left{.tv_sec = left_ns / 1'000'000'000, .tv_nsec = left_ns % 1'000'000'000};
    pollfd signal{.fd = signals_.descriptor(), .events = POLLIN, .revents = 0};
    ppoll(&signal, 1, &left, nullptr);
    return true;
  }

 private:
  double speed_;
  bool hardware_;
  RemoteControl* remote_;
  const StopSignals& signals_;
  Time start_{};
  std::int64_t start_ns_ = monotonic_ns();
};

}  // namespace

SimulatedRun::SimulatedRun(std::uint32_t instances, std::uint64_t seed)
    : random_(seed),
      is_ready_(instances),
      has_ended_(instances),
      deadlines_(instances),
      beats_(instances),
      stuck_(instances) {
  ready_.reserve(instances);
}

void SimulatedRun::wake(std::uint32_t instance) {
  if (is_ready_[instance] || has_ended_[instance]) return;
  is_ready_[instance] = true;
  ready_.push_back(instance);
}

std::uint32_t SimulatedRun::draw_ready(const Assembly& assembly) {
  if (assembly.scenario && assembly.scenario->times) {
    const std::vector<std::uint32_t>& place = assembly.scenario->times->place;
    const auto order = [&](std::uint32_t instance) {
      return std::tuple(assembly.executors[instance]->order(), place[instance], instance);
    };
    std::iter_swap(std::ranges::min_element(ready_, {}, order), std::prev(ready_.end()));
  } else if (ready_.size() > 1) {
    // Not std::uniform_int_distribution: its numbers differ from library to library.
    std::swap(ready_[random_() % ready_.size()], ready_.back());
  }
  const std::uint32_t drawn = ready_.back();
  ready_.pop_back();
  is_ready_[drawn] = false;
  return drawn;
}

void SimulatedRun::step(Assembly& assembly, UpperLayers& upper, std::uint32_t instance) {
  SubsystemExecutor& executor = *assembly.executors[instance];
  const bool one = remote_ != nullptr && remote_->one_by_one();
  // A scenario of times says the order of whole turns.
  const bool interleaves = assembly.options.interleave && !(assembly.scenario && assembly.scenario->times);
  if (one) remote_->about_to_fire();
  const std::uint64_t before = executor.firings();
  calls_->begin(instance, clock_.now());
  const SubsystemExecutor::Progress progress = executor.step(one || interleaves ? 1 : UINT64_MAX);
  calls_->end();
  if (one && executor.firings() != before) remote_->fired(instance);
  if (executor.firings() != before) last_firing_ = clock_.now();
  if (progress.state == SubsystemExecutor::State::ready) {
    if (!interleaves) {
      unfinished_ = instance;
      return;
    }
    wake(instance);
  }
  deadlines_.set(instance,
                 progress.state == SubsystemExecutor::State::waiting ? progress.deadline : Time::max());
  beats_.set(instance, progress.state == SubsystemExecutor::State::waiting ? progress.beat : Time::max());
  if (progress.state != SubsystemExecutor::State::ended) return;
  has_ended_[instance] = true;
  upper.subsystem_ended(instance, clock_.now());
}

/// The world moves in short steps, so that a signal ends the run even if the world is slow. The clock goes
/// only as far as the world has come.
void SimulatedRun::move_to(Assembly& assembly, Time time) {
  constexpr Duration world_step = std::chrono::milliseconds(10);
  Time reached = assembly.world == nullptr ? time : clock_.now();
  const auto advance = [&] {
    do {
      reached = std::min(time, reached + world_step);
      assembly.world->advance_to(reached);
    } while (reached < time && StopSignals::pending() == 0);
    notice_failed_checks(assembly);
    record_failed_checks(assembly, reached);
  };
  if (assembly.world != nullptr && !survives_in_thread(assembly.control, "the world", advance))
    world_failure_ = Failure::world;
  clock_.set(reached);
  if (published_) published_->move_to(reached);
}

/// Why the run ends now; nullopt: it goes on.
std::optional<Ending> SimulatedRun::stopped(const Assembly& assembly) const {
  if (const int signal = StopSignals::pending(); signal != 0)
    return Ending{StopSignals::name(signal), assembly.control.failed(), clock_.now(), signal, std::nullopt};
  if (!assembly.control.stopping()) return std::nullopt;
  return Ending{fmt::format("stopped: {}", assembly.control.reason()),
                assembly.control.failed(),
                clock_.now(),
                0,
                std::nullopt,
                world_failure_};
}

/// A device may have noticed the failure of the world before the clock did. The reported ending is then only
/// a consequence.
Ending SimulatedRun::with_failure_of_world(Ending ending, Assembly& assembly) const {
  if (assembly.world == nullptr || !ending.failed || world_failure_ != Failure::none) return ending;
  try {
    assembly.world->advance_to(clock_.now());
  } catch (const std::exception& failure) {
    ending.text = fmt::format("stopped: the world: {}", failure.what());
    ending.failed = true;
    ending.failure = Failure::world;
  }
  return ending;
}

/// Gives safe commands to all devices at this instant, not at the next turns of their subsystems.
void SimulatedRun::follow_emergency(Assembly& assembly) {
  using News = EmergencyWatch::News;
  const RunControl& control = assembly.control;
  for (News news = emergencies_.look(control); news != News::none; news = emergencies_.look(control)) {
    for (const auto& executor : assembly.executors) executor->guard();
    EmergencyWatch::say(news, control, clock_.now(),
                        assembly.recorder == nullptr ? nullptr : assembly.recorder->system_lane());
  }
}

/// Processes die and begin again.
void SimulatedRun::follow_processes(Assembly& assembly, UpperLayers& upper) {
  std::string error;
  while (const auto change = lives_.follow(assembly, upper, clock_.now(), error))
    for (const std::uint32_t instance : change->instances) {
      has_ended_[instance] = change->died;
      if (!change->died) {
        wake(instance);
        continue;
      }
      std::erase(ready_, instance);
      is_ready_[instance] = false;
      if (unfinished_ == instance) unfinished_.reset();
      for (DeadlineQueue* queue : {&deadlines_, &beats_}) queue->set(instance, Time::max());
    }
  if (!error.empty()) assembly.control.request_stop("a process cannot begin again: " + error, /*fault=*/true);
}

/// A subsystem finishes its turn, however often the turn is interrupted, so that the run stays the same.
/// true: the run was paused in the meantime.
bool SimulatedRun::fire_what_is_ready(Assembly& assembly, UpperLayers& upper, const StopSignals& signals) {
  bool waited = false;
  while ((unfinished_ || !ready_.empty()) && !assembly.control.stopping()) {
    if (remote_ != nullptr) {
      waited = remote_->wait_while_paused(signals) || waited;
      if (StopSignals::pending() != 0) break;
    }
    const std::uint32_t instance = unfinished_ ? *unfinished_ : draw_ready(assembly);
    unfinished_.reset();
    if (!has_ended_[instance]) step(assembly, upper, instance);
    follow_emergency(assembly);
  }
  if (remote_ != nullptr) waited = remote_->wait_while_paused(signals) || waited;
  return waited;
}

Ending SimulatedRun::run(Assembly& assembly, UpperLayers& upper, const StopSignals& signals) {
  if (assembly.options.monitor) {
    skip_to_ = assembly.options.skip_to;
    remote_ = std::make_unique<RemoteControl>(assembly, assembly.options.paused && !skip_to_,
                                              assembly.options.speed);
    monitor_.emplace(assembly, clock_, Monitor::listen(assembly), remote_.get());
    monitor_->warn_of_failure(clock_.now());
  }
  calls_.emplace(assembly);
  Ending ending =
      with_failure_of_world(with_stuck(run_until_end(assembly, upper, signals), assembly), assembly);
  for (std::size_t instance = 0; instance < assembly.executors.size(); ++instance)
    if (!has_ended_[instance]) assembly.executors[instance]->leave();
  // does not wait for a device that refuses
  for (const auto& executor : assembly.executors) executor->insist();
  calls_.reset();
  return ending;
}

std::optional<Ending> SimulatedRun::follow_scenario(Assembly& assembly, UpperLayers& upper) {
  if (!assembly.scenario || assembly.scenario->times) return std::nullopt;
  const std::vector<Scenario::Step>& steps = assembly.scenario->steps;
  for (std::size_t index = 0; index < steps.size(); ++index) {
    const SubsystemExecutor& executor = *assembly.executors[steps[index].instance];
    const bool followed = follow_step(assembly, upper, index);
    if (std::optional<Ending> ended = stopped(assembly)) return ended;
    if (!followed)
      return Ending{fmt::format("the scenario cannot be followed: {} cannot fire; {}", steps[index].name,
                                executor.whereabouts(assembly.system)),
                    true,
                    clock_.now(),
                    0,
                    std::nullopt,
                    Failure::scenario};
  }
  for (const auto& executor : assembly.executors) firings_at_scenario_end_.push_back(executor->firings());
  console::print(LogLevel::info, clock_.now(), "tessera", "end of the scenario; everything runs freely");
  return std::nullopt;
}

/// Lets time pass until the step can be made. false: it can never be made.
bool SimulatedRun::follow_step(Assembly& assembly, UpperLayers& upper, std::size_t index) {
  const Scenario::Step& step = assembly.scenario->steps[index];
  SubsystemExecutor& executor = *assembly.executors[step.instance];
  for (;;) {
    calls_->begin(step.instance, clock_.now());
    const SubsystemExecutor::FollowProgress progress = executor.follow();
    calls_->end();
    if (progress.state == SubsystemExecutor::Followed::waiting) {
      if (serve_links(assembly)) continue;
      const Time next = std::min(progress.deadline, next_of_links(assembly));
      if (next == Time::max()) return false;
      move_to(assembly, std::max(next, clock_.now()));
      if (stopped(assembly)) return false;
      continue;
    }
    last_firing_ = clock_.now();
    const std::string_view local = std::string_view(step.name).substr(executor.path().size() + 1);
    executor.note(progress.forced.empty()
                      ? fmt::format("scenario {}/{}: {}", index + 1, assembly.scenario->steps.size(), local)
                      : fmt::format("scenario {}/{}: {} (forced: {})", index + 1,
                                    assembly.scenario->steps.size(), local, progress.forced));
    if (progress.state == SubsystemExecutor::Followed::ended) {
      has_ended_[step.instance] = true;
      upper.subsystem_ended(step.instance, clock_.now());
    }
    return true;
  }
}

Ending SimulatedRun::with_stuck(Ending ending, const Assembly& assembly) const {
  std::string stuck;
  for (std::uint32_t instance = 0; instance < firings_at_scenario_end_.size(); ++instance) {
    const SubsystemExecutor& executor = *assembly.executors[instance];
    if (has_ended_[instance] || executor.firings() != firings_at_scenario_end_[instance]) continue;
    stuck += (stuck.empty() ? "" : "; ") + executor.whereabouts(assembly.system);
  }
  if (stuck.empty() || ending.failed) return ending;  // the reason of the failure says more
  ending.text += "; stuck since the scenario: " + stuck;
  ending.failed = true;
  ending.failure = Failure::stuck;
  return ending;
}

/// Delivers messages that have arrived, and sends those of the ends of channels. true: there was one.
bool SimulatedRun::serve_links(Assembly& assembly) {
  if (assembly.links == nullptr) return false;
  const Time now = clock_.now();
  if (!assembly.links->has_work(now) && assembly.network->next() > now) return false;
  assembly.links->serve(now);
  return true;
}

/// Time::max(): never, or no subsystem has fired or waited for a time for so long that no change can follow.
Time SimulatedRun::next_of_links(const Assembly& assembly) const {
  constexpr Duration hopeless = std::chrono::minutes(1);
  if (assembly.links == nullptr) return Time::max();
  const Time since = std::max(last_firing_, assembly.network->last_cut());
  if (deadlines_.empty() && clock_.now() - since > hopeless) return Time::max();
  return std::min(assembly.links->next(), assembly.network->next());
}

Ending SimulatedRun::run_until_end(Assembly& assembly, UpperLayers& upper, const StopSignals& signals) {
  const std::optional<Duration> duration = assembly.options.duration;
  Pace pace(assembly.options.realtime || published_, !assembly.options.hardware.empty(), remote_.get(),
            signals);
  ProgressLine progress(assembly.options.progress, duration);
  const auto ending = [&](std::string text, bool failed, Failure failure = Failure::none) {
    return Ending{std::move(text), failed, clock_.now(), 0, std::nullopt, failure};
  };

  move_to(assembly, Time{});
  upper.enter(clock_.now());
  for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance) {
    assembly.executors[instance]->enter();
    wake(instance);
  }
  if (std::optional<Ending> ended = follow_scenario(assembly, upper)) return *ended;
  Time end = duration ? clock_.now() + *duration : Time::max();
  if (assembly.scenario && assembly.scenario->times)
    end = std::min(end, assembly.scenario->times->end + Duration(1));
  for (;;) {
    if (assembly.restarts != nullptr) follow_processes(assembly, upper);
    if (fire_what_is_ready(assembly, upper, signals)) pace.restart(clock_.now());
    if (std::optional<Ending> ended = stopped(assembly)) return *ended;
    if (upper.ended() && !lives_.awaits_start()) return ending("net ended", false);
    if (serve_links(assembly)) continue;
    Time next = deadlines_.empty() ? Time::max() : deadlines_.first_time();
    const Time linked = next_of_links(assembly);
    if (next != Time::max() || linked != Time::max() || lives_.awaits_start())
      next = std::min({next, linked, assembly.signals.next(), lives_.next(assembly)});
    if (next == Time::max())
      return ending("stopped: " + why_nothing_happens(assembly), true, Failure::deadlock);
    stuck_.look(assembly, clock_.now());
    if (!beats_.empty()) next = std::min(next, beats_.first_time());
    if (remote_ != nullptr) remote_->keep_recording_live();
    const bool skips = skip_to_ && std::min(next, end) < Time(*skip_to_);
    if (skip_to_ && !skips) {
      skip_to_.reset();
      pace.restart(clock_.now());
      if (assembly.options.paused) remote_->pause();
      continue;
    }
    if (published_ && published_->next() < std::min(next, end)) {
      if (skips || pace.wait_for(published_->next(), clock_.now(), assembly.recorder.get()))
        published_->publish(published_->next());
      continue;
    }
    if (!skips && !pace.wait_for(std::min(next, end), clock_.now(), assembly.recorder.get())) continue;
    move_to(assembly, std::min(next, end));
    if (std::optional<Ending> ended = stopped(assembly)) return *ended;
    if (next >= end) return ending("duration", assembly.control.failed());
    assembly.signals.raise_due(next);
    progress.update(next);
    for (DeadlineQueue* queue : {&deadlines_, &beats_})
      while (!queue->empty() && queue->first_time() <= next) {
        const std::uint32_t due = queue->first();
        queue->set(due, Time::max());
        wake(due);
      }
  }
}

}  // namespace tessera
