#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "explore/formula.hpp"
#include "explore/pt_net.hpp"
#include "explore/watch.hpp"

/// Questions about the reachable markings of a place/transition net, answered by visiting them. Nets may have
/// arc weights and any number of tokens; unbounded nets end at a limit.
///
/// All functions: time and memory as `limits` says, `unknown` with the reason when that does not suffice; one
/// thread; deterministic, but for where a limit cuts. Markings take 5 to 7 bytes and what their places need:
/// a set of places that a place invariant allows one token takes the bits of one number.
namespace tessera::explore {

/// A run from the initial marking.
struct Trace {
  std::vector<TransitionId> firings;
  Marking end;  ///< the marking it leads to
};

struct Answer {
  enum class Kind : std::uint8_t { yes, no, unknown } kind = Kind::unknown;
  std::string why;        ///< of unknown, in one line
  Trace trace;            ///< of the answer that a run can show (see each question)
  bool shortest = false;  ///< no shorter trace shows it
  /// leads_to: the firings of the trace after which `p` holds.
  std::size_t turn = 0;
  Effort effort;
};

struct Count {
  bool complete = false;
  std::string why;             ///< of not complete
  std::uint64_t markings = 0;  ///< reachable, or found so far
  std::uint64_t edges = 0;     ///< enabled transitions, summed over those markings
  Tokens most_tokens = 0;      ///< in any place of any marking
  Effort effort;
};
/// How many markings are reachable.
[[nodiscard]] Count count(const PtNet& net, const Limits& limits);

/// Is a marking reachable of which `goal` is true? yes: with a shortest run to one.
[[nodiscard]] Answer find(const PtNet& net, const Formula& goal, const Limits& limits);

/// Is a dead marking reachable of which `is_final` is not true? yes: with a run to one, which is shortened as
/// far as a second look of limited cost allows.
///
/// Explores only a stubborn set of the enabled transitions of each marking, depth first.
/// Source: Valmari, stubborn sets for reduced state space generation (deadlock-preserving strong sets).
[[nodiscard]] Answer find_deadlock(const PtNet& net, const Formula& is_final, const Limits& limits);

/// Can a marking of which `goal` is true be reached from every reachable marking (AG EF)? no: with a shortest
/// run to one from which none can.
[[nodiscard]] Answer always_reachable(const PtNet& net, const Formula& goal, const Limits& limits);

/// From every reachable marking of which `p` is true, does `q` come if every offered branch is eventually
/// taken? That is, no run from there that avoids `q` ends where `q` can no longer be reached. no: with a run
/// that reaches `p` after `turn` firings and ends where `q` is out of reach, without `q` in between.
[[nodiscard]] Answer leads_to(const PtNet& net, const Formula& p, const Formula& q, const Limits& limits);

/// From every reachable marking, can a transition of the set be fired at some time, unless ...
struct Obligation {
  std::vector<TransitionId> any_of;
  Formula unless = Formula::never();  ///< ... this is true then, or can be reached
};
/// One answer for each obligation, all from one graph; no: with a shortest run to a marking from which
/// neither.
[[nodiscard]] std::vector<Answer> can_always_fire(const PtNet& net,
                                                  const std::vector<Obligation>& obligations,
                                                  const Limits& limits);

/// The marking a run leads to; nullopt if it is none of the net.
[[nodiscard]] std::optional<Marking> replay(const PtNet& net, const std::vector<TransitionId>& firings);

}  // namespace tessera::explore
