// The run that makes a command as old as it can be.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "timing/bounds.hpp"
#include "timing/declared.hpp"

namespace tessera::timing {

/// A call of a transition function in a run. Its order matters among those that can act at one instant: the one with
/// the smaller number goes first, and the earlier subsystem of the specification among equals.
struct CallOfRun {
  std::uint32_t subsystem = 0;
  std::uint32_t number = 0;  ///< counted from 0
  Time begin = 0, end = 0;   ///< of the device reading, and of the command
  Time late = 0;             ///< from its release to its beginning, because of the latency or the processor
  std::int8_t order = 0;
};
/// The value on its way: when it was written, and when it was received for the last time before it was used.
struct HopOfRun {
  std::uint32_t channel = 0;
  Time written = 0, read = 0;
};
struct WorstRun {
  Time from = 0;         ///< the reading of the device; for a reaction, an event just after that reading
  Time to = 0;           ///< the end of the command
  bool reaches = false;  ///< the bound
  std::vector<CallOfRun>
      calls;  ///< of all subsystems that matter, from the start of the run to its end, by their begin
  std::vector<HopOfRun> hops;  ///< of the value that the command is based on
  /// Under the simulated clock the controller makes it, if calls take as long as here: only calls begin late.
  bool on_simulated_clock = true;

  [[nodiscard]] Time time() const { return to - from; }
};

/// nullopt: there is no bound, or no command was given.
struct WorstRuns {
  std::optional<WorstRun> age, reaction;
};

/// Searches runs, with a measure of work that is the same on every machine.
///
/// The search plays runs, with calls as short or as long as the specification says, and an order of those that can
/// act at one instant. It goes back along the way of the value, and makes late what should be late, and early what
/// should just miss it. Then it climbs by changes of single calls. Chains that are equal, as in fleets, have one search.
///
/// Threads: one.
class WorstRunSearch {
 public:
  /// most_steps: of all searches together; a step is one firing, a microsecond at most.
  explicit WorstRunSearch(const Declared& declared, const Bounds& bounds, StopAsked stop = {},
                          std::uint64_t most_steps = 40'000'000)
      : declared_(declared), bounds_(bounds), stop_(std::move(stop)), left_(most_steps) {}

  /// Why the runs of the search might not be those of the controller, so that nothing is searched: "the behaviours of
  /// robot.control do not all take the same time". Empty: they are.
  [[nodiscard]] std::string obstacle(const Chain& way, const spec::Model& model) const;
  /// The runs that come nearest to the bounds of the chain: of its slowest way. Throws Interrupted.
  [[nodiscard]] WorstRuns find(const DeclaredChain& chain);
  [[nodiscard]] WorstRuns find(const Chain& way) { return {find(way, true), find(way, false)}; }

 private:
  /// A part of a system that a chain depends on, with numbers of its own, equal for equal parts.
  struct Part {
    System system;
    Chain chain;
    std::vector<std::uint32_t> subsystems;  ///< their numbers in the whole

    [[nodiscard]] std::vector<Time> key() const;
  };
  struct Found {
    std::vector<Time> key;
    std::optional<WorstRun> run;  ///< with the numbers of the part
  };

  static constexpr std::uint64_t most_steps_of_one = 2'000'000;

  struct Obstacle {
    enum class Kind : std::uint8_t { missing, differ, takes_turns, too_many } kind = Kind::missing;
    std::uint32_t subsystem = 0;
  };
  static constexpr std::size_t most_subsystems = 64;

  [[nodiscard]] std::optional<Obstacle> obstacle(const std::vector<std::uint32_t>& subsystems) const;
  [[nodiscard]] std::vector<std::uint32_t> depends_on(const Chain& way) const;
  [[nodiscard]] Part part_of(const Chain& way) const;
  [[nodiscard]] std::optional<WorstRun> find(const Chain& way, bool age);

  const Declared& declared_;
  const Bounds& bounds_;
  StopAsked stop_;
  std::uint64_t left_;
  std::vector<Found> found_;
};

}  // namespace tessera::timing
