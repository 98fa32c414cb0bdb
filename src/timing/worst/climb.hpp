// The search for the run with the largest age or reaction.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "timing/patience.hpp"
#include "timing/worst/played_run.hpp"

namespace tessera::timing {

/// How far a run has come, for one reading of the device.
struct Reached {
  Time time = -1;  ///< the age or the reaction; -1: no command was given
  Time newer =
      0;  ///< the sum of the times at which newer values than that of the reading were written: later
          ///< ones are a step towards a larger time
  std::uint32_t reading = 0;  ///< the call of the first subsystem
  std::uint32_t command = 0;  ///< into RunLog::commands

  [[nodiscard]] bool is_before(const Reached& other) const {
    return time != other.time ? time < other.time : newer < other.newer;
  }
};

class Climb {
 public:
  struct Goal {
    bool age = false;  ///< else the reaction
    Time bound = 0;
    Time reading = -1;  ///< when the device is read in the run of the bound; -1: it is not known
    Time pattern = 0;   ///< after that time everything repeats; 0: it is not known
  };

  /// most_steps: see PlayedRun::steps.
  Climb(const System& system, const Chain& chain, const Goal& goal, std::uint64_t most_steps,
        const StopAsked& stop);

  /// false: no command was given in any run. Throws Interrupted.
  bool search();
  [[nodiscard]] const Reached& best() const { return best_; }
  [[nodiscard]] std::uint64_t steps() const { return run_.steps(); }
  /// The best run once more.
  [[nodiscard]] const RunLog& replay() { return run_.play(best_plan_, best_until_); }
  [[nodiscard]] const RunPlan& plan() const { return best_plan_; }

 private:
  struct Call {
    std::uint32_t subsystem = 0, number = 0;
  };
  struct Change {
    Call call;
    PlannedCall planned;
  };
  using Changes = std::vector<Change>;
  enum class Start : std::uint8_t { slow, quick, chain_quick, mixed };

  [[nodiscard]] bool is_over() const { return best_.time >= goal_.bound || run_.steps() >= most_steps_; }
  [[nodiscard]] std::vector<Time> readings_to_try() const;
  [[nodiscard]] RunPlan begin_with(Start start);
  [[nodiscard]] Reached measure(const RunLog& log, std::optional<std::uint32_t> reading) const;
  [[nodiscard]] Reached measure_age(const RunLog& log, std::optional<std::uint32_t> reading) const;
  [[nodiscard]] Reached measure_reaction(const RunLog& log, std::optional<std::uint32_t> reading) const;
  [[nodiscard]] Time newer_of(const RunLog& log, std::int64_t reading) const;
  Reached play(const RunPlan& plan, std::optional<std::uint32_t> reading);

  void improve(RunPlan plan, Time reading);
  [[nodiscard]] std::vector<Changes> proposals(const RunLog& log, const RunPlan& plan,
                                               const Reached& reached);
  void propose_around(Call call, const RunPlan& plan, std::vector<Changes>& all) const;
  void propose_shifts(std::uint32_t subsystem, std::int64_t number, Time by, const RunPlan& plan,
                      std::vector<Changes>& all) const;
  void climb_by_chance();
  void keep(const Reached& reached, const RunPlan& plan);
  bool apply(RunPlan& plan, Changes& changes) const;

  [[nodiscard]] PlannedCall slow(std::uint32_t i) const { return {system_.subsystems[i].longest, 1, true}; }
  [[nodiscard]] PlannedCall quick(std::uint32_t i) const { return {shortest(i), -1, false}; }
  [[nodiscard]] Time shortest(std::uint32_t i) const;
  [[nodiscard]] std::uint64_t draw(std::uint64_t below);

  const System& system_;
  const Chain& chain_;
  Goal goal_;
  std::uint64_t most_steps_;
  const StopAsked& stop_;
  PlayedRun run_;
  Time until_ = 0;          ///< of the runs that are played now
  Time longest_round_ = 1;  ///< the longest period or call
  std::uint64_t random_ = 0;
  Reached best_;
  RunPlan best_plan_;
  Time best_until_ = 0;
};

/// The call of a subsystem in which something happened at that time: the last one that had begun. -1: none had.
[[nodiscard]] std::int64_t call_at(const RunLog& log, std::uint32_t subsystem, Time at);

}  // namespace tessera::timing
