#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nets/plan.hpp"
#include "subsystem/gauges.hpp"
#include "subsystem/memory_gauge.hpp"
#include "subsystem/operations.hpp"
#include "subsystem/releases.hpp"
#include "subsystem/scenario.hpp"

namespace tessera {

/// Executes the net of one subsystem: fires enabled transitions, starts the operations of the places that get
/// tokens, and reports what it waits for. It can be resumed, so that one thread runs all subsystems in
/// simulated time, and each subsystem has its own thread in real time.
///
/// The rule of firing: a transition fires if its places in the subsystem hold tokens whose operations have
/// finished, its condition holds, and the channel it touches, if any, makes its part of the firing
/// (SharedChannel::fire). This last step is the only one that other threads can interfere with. If a
/// transition with a timeout has alternatives, these are tried first.
///
/// *Release.* The operation `call` of a subsystem with a rate starts at the first instant k * period that is
/// not before the token's arrival and later than that of the call before. All behaviours share these
/// instants. The first call starts at once. Instants passed over are overruns, unless the time was spent
/// waiting for other subsystems. With Overrun::catch_up, the missed calls follow late, one after the other.
/// If the subsystem receives first, the instants are those of the operation `begin`, and `call` starts at
/// once.
///
/// *Ends.* When the token is in `out`, the subsystem has ended. This is a fault, which stops the system, if
/// it happens after an error (no entry of `next` leads to another behaviour). It is also a fault if no
/// condition of `next` holds, or if one throws.
///
/// Threads: the subsystem's. No allocation and no lock in `step`, apart from what user code does.
class SubsystemExecutor {
 public:
  struct Shared {
    RunControl& control;
    const Clock& clock;
    Waker& waker;
    bool watched = false;  ///< an observer may read the gauges
  };
  /// first_transition: how the recording numbers the net's transitions.
  SubsystemExecutor(std::uint32_t index, SubsystemParts parts, std::shared_ptr<const Plan> plan,
                    std::uint32_t first_transition, Shared shared, RecordingLane* lane);

  /// Puts the token into `in`: t_in of the agent has fired.
  void enter();

  enum class State : std::uint8_t { waiting, ended, stopped, ready };
  struct Progress {
    State state = State::waiting;
    Time deadline = Time::max();  ///< waiting: step again then, or when woken
    Time beat = Time::max();      ///< waiting: when a device needs a heartbeat; nothing else happens then
  };
  /// Fires until no transition may fire now. Wakes subsystems that receive from this one when it ends.
  /// most: how many firings and operations at most; ready: it could have gone on.
  [[nodiscard]] Progress step(std::uint64_t most = UINT64_MAX);

  /// From now on only `follow` makes it fire: these transitions of its table, in this order. Conditions are not
  /// evaluated for a token that one of them decides on. If it is a scenario of times, calls begin and end as it says.
  /// scenario: kept, not copied.
  void set_scenario(const Scenario& scenario) {
    script_ = scenario.of_instance(index_);
    if (scenario.times) forced_ = scenario.times->calls[index_];
  }
  /// The one with the smallest number goes first of those that can act at one instant.
  [[nodiscard]] std::int32_t order() const {
    const ForcedCall* const call = forced_call();
    return call == nullptr ? 0 : call->order;
  }
  /// Fires the next transition of the script. waiting: not yet, step again at the deadline, or never
  /// (Time::max()); fired: done. Precondition: there is a next one.
  enum class Followed : std::uint8_t { fired, ended, waiting };
  struct FollowProgress {
    Followed state = Followed::waiting;
    Time deadline = Time::max();
    std::string_view forced{};  ///< the result that a condition was forced to have
  };
  [[nodiscard]] FollowProgress follow();
  /// Writes a line to the console and the recording.
  void note(std::string_view text) { operations_.reports().log(LogLevel::info, text); }

  /// The transition function of call `since` has run longer than the watchdog allows: marks that, and makes
  /// the subsystems that receive from this one check their devices; false: it has returned meanwhile.
  /// Threads: any.
  [[nodiscard]] bool mark_alarm(std::int64_t since_ns);
  /// Reports this. Threads: any, with a lane of its own.
  void tell_alarm(RecordingLane* lane) const;

  /// Its thread has gone on so long after it might. Threads: as `step`.
  void note_wakeup(Duration late);
  void enter_thread() { operations_.overtimes().enter_thread(); }

  /// Gives the safe command if there is a reason for it now. Threads: as `step`.
  void guard() {
    if (!marked_.empty()) operations_.devices().guard(clock_.now(), name_of(marked_.front()));
  }
  /// Gives the safe command, whenever the run ends. `insist` gives it again to devices that have refused it.
  void leave() { operations_.devices().leave(); }
  void insist() { operations_.devices().insist(); }
  /// Threads: as its members say.
  [[nodiscard]] Effectors& effectors() { return operations_.devices().effectors(); }
  /// Calls the heartbeats that are due, while it waits, and returns when the next one is.
  Time beat(Time now) {
    operations_.devices().beat(now, name_of(marked_.front()));
    return operations_.devices().next_beat();
  }

  /// The tokens of one channel that a transition lacks, if it lacks nothing else except time.
  struct Lack {
    std::uint32_t port;
    std::uint16_t tokens;  ///< fused places, as bits
  };
  /// The lack of every transition that it can still fire. nullopt: it can go on by itself, has work to do, or
  /// waits for a time. Threads: when it does not run.
  [[nodiscard]] std::optional<std::vector<Lack>> lacks() const;
  /// Per port, the fused places that it may give tokens to from here on, whatever its conditions say.
  /// helped: per port, whether the other end may give tokens too. Threads: when it does not run.
  [[nodiscard]] std::vector<std::uint16_t> may_give(const std::vector<bool>& helped) const;
  /// The time of the last firing before it began to wait. Time::max(): it has not waited yet.
  [[nodiscard]] Time waits_since() const { return waits_since_; }

  /// "robot.control in follow.rcv.line.in (waits for robot.sensor)"; for reports, when the thread
  /// does not run.
  [[nodiscard]] std::string whereabouts(const System& system) const;

  [[nodiscard]] const std::string& path() const { return operations_.parts().path; }
  [[nodiscard]] const Operations& operations() const { return operations_; }
  [[nodiscard]] Operations& operations() { return operations_; }
  /// Records what has happened to the thread of the subsystem. Threads: the subsystem's.
  /// Async-signal-safe.
  void record_death(std::string_view text) { operations_.reports().record_death(text); }
  [[nodiscard]] const Gauges& gauges() const { return gauges_; }
  /// nullptr: there is no memory, or observers are not allowed.
  [[nodiscard]] const MemoryGauge* memory() const { return memory_.get(); }
  [[nodiscard]] std::uint64_t firings() const { return firings_; }
  [[nodiscard]] std::uint64_t overruns() const { return releases_.overruns(); }
  /// Whether that place of the table holds a token.
  [[nodiscard]] bool holds(std::uint32_t place) const { return tokens_[place].position.valid(); }

  /// The transition of the table that fired last. Precondition: one has, and the run is recorded.
  [[nodiscard]] std::uint32_t last_fired() const { return last_fired_; }
  /// Whether its tokens in this subsystem are there, and its condition holds; channels may still prevent it.
  [[nodiscard]] bool wants_to_fire(std::uint32_t transition) const;

  /// Under the simulated clock, so many firings of a subsystem at one instant mean that time stands still.
  static constexpr std::uint32_t firings_per_instant = 100'000;

  /// In real time, a subsystem that runs no user code for so many firings checks the clock and RunControl.
  static constexpr std::uint32_t look_up = 64;

 private:
  enum class Phase : std::uint8_t { released_later, running, finished };
  using MarkedId = Id<struct MarkedTag>;  // into marked_; of facts 0
  struct Token {
    Time arrival{};  // in places from which a timeout counts
    Time due{};      // of released_later and running
    Phase phase = Phase::finished;
    std::int32_t latched = 0;  // the outcome or the entry of `next`
    MarkedId position{};
  };

  void renew_time();
  [[nodiscard]] Time now();
  [[nodiscard]] Time time_of_conditions() { return operations_.has_inputs() ? now() : now_; }

  [[nodiscard]] bool fire_one();
  [[nodiscard]] bool try_fire(std::uint32_t transition);
  [[nodiscard]] bool walk();
  [[nodiscard]] const Plan::TransitionEntry* fire_one_of(const Plan::TransitionEntry* departure);
  [[nodiscard]] bool fire_enabled(const Plan::TransitionEntry& transition);
  [[nodiscard]] bool outwait_peer();
  [[nodiscard]] bool locally_enabled(const Plan::TransitionEntry& transition) const;
  [[nodiscard]] bool condition_holds(const Plan::TransitionEntry& transition) const;
  [[nodiscard]] Time elapses(const Plan::TransitionEntry& transition) const;
  [[nodiscard]] std::uint32_t tell_network(NetworkEnd& end, const Plan::TransitionEntry& transition);
  void tell_of_timeout(const Plan::TransitionEntry& transition);

  void move_tokens(const Plan::TransitionEntry& transition);
  void take(std::uint32_t place);
  void put(std::uint32_t place);
  void arrive(std::uint32_t place);
  void check_way_out(std::uint32_t place);
  [[nodiscard]] bool fits_facts(const Plan::TransitionEntry& transition) const;
  void look_for_way_out(std::uint32_t place);
  void arrive_at_end();
  [[nodiscard]] bool advance_operations();

  // Calls.
  [[nodiscard]] Time release();
  /// The one that runs, or comes next. nullptr: its times are not forced.
  [[nodiscard]] const ForcedCall* forced_call() const {
    const std::size_t index = releases_made_ == 0 ? 0 : releases_made_ - 1;
    return index < forced_.size() ? &forced_[index] : nullptr;
  }
  [[nodiscard]] bool advance(std::uint32_t place);
  void end_alarm();
  void wake_receivers();
  [[nodiscard]] std::string_view name_of(std::uint32_t place) const {
    return operations_.parts().instance->net->places[place].name;
  }
  void show();

  // Scripts.
  [[nodiscard]] const Plan::TransitionEntry* decided_by_script(std::uint32_t place) const;
  [[nodiscard]] bool script_ends_without_choice() const;
  void take_told(std::uint32_t place);
  void decide(std::uint32_t place);
  void route(std::uint32_t place);
  void ask(std::uint32_t place);
  [[nodiscard]] Time script_deadline(std::uint32_t transition) const;

  [[nodiscard]] bool register_waits();
  [[nodiscard]] Time next_deadline() const;
  [[nodiscard]] bool time_stands_still();
  void fault(std::uint32_t place, std::string_view text);
  void end();

  std::uint32_t index_;
  Operations operations_;
  Releases releases_;
  std::shared_ptr<const Plan> plan_;
  std::uint32_t first_transition_;
  RunControl& control_;
  const Clock& clock_;
  Waker& waker_;
  RecordingLane* lane_;

  Time now_{};                  // of the last look at the clock
  bool time_is_known_ = false;  // no user code has run since
  bool watched_, simulated_;
  bool watches_time_ = true;        // what it does next may depend on the time: a rate, a timeout, a device
  bool at_end_ = false;             // the token is in `out`
  const PortLink* ports_;           // of operations_
  const Plan::PlaceEntry* places_;  // of plan_
  const SharedChannel* held_ = nullptr;  // a channel whose memory is in use, and for which some transition
                                         // waits

  std::vector<Token> tokens_;              // per place
  std::vector<std::uint32_t> marked_;      // places with a token, without those of facts; room for all
  std::vector<std::uint16_t> wants_;       // per port: registered in its channel
  std::vector<std::uint16_t> wants_next_;  // per port: scratch of register_waits
  std::uint32_t registrations_ = 0;        // ports with wants_

  Scenario::Script script_;   // to follow
  std::size_t followed_ = 0;  // of the script

  std::span<const ForcedCall> forced_;  // times of calls
  std::size_t releases_made_ = 0;

  Time returns_{};  // simulated: the return of a call that the watchdog precedes
  Time blocked_since_ = Time::max();
  Duration waited_{0};  // for other subsystems, since the last call
  Time waits_since_ = Time::max();
  std::uint64_t waits_after_ = UINT64_MAX;  // firings_ at waits_since_
  std::uint64_t firings_ = 0;
  std::uint32_t last_fired_ = 0;
  Gauges gauges_;
  std::unique_ptr<MemoryGauge> memory_;
  Time instant_ = Time::min();
  std::uint32_t fired_at_instant_ = 0;
};

inline bool SubsystemExecutor::condition_holds(const Plan::TransitionEntry& transition) const {
  if (transition.guard.kind == Guard::Kind::none) return true;
  if (transition.guard.kind == Guard::Kind::elapsed) return now_ >= elapses(transition);
  return tokens_[transition.latch.value].latched == transition.decided;
}

}  // namespace tessera
