#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "explore/formula.hpp"
#include "explore/pt_net.hpp"
#include "explore/watch.hpp"

/// Questions about the reachable markings of a place/transition net, answered by visiting them. Nets may
/// have arc weights and any number of tokens; for unbounded nets, the exploration ends at a limit.
///
/// All functions: time and memory are bounded by `limits`; if that does not suffice, the answer is
/// `unknown` with the reason. One thread; deterministic, except for the point at which a limit ends the
/// search. A marking takes 5 to 7 bytes plus the bits of its places. A set of places to which a place
/// invariant allows one token takes the bits of one number.
namespace tessera::explore {

/// A run from the initial marking.
struct Trace {
  std::vector<TransitionId> firings;
  Marking end;  ///< the marking it leads to
};

struct Answer {
  enum class Kind : std::uint8_t { yes, no, unknown } kind = Kind::unknown;
  std::string why;        ///< reason of `unknown`, in one line
  Trace trace;            ///< if a run can show the answer (see each question)
  bool shortest = false;  ///< there is no shorter trace with this property
  /// find_deadlock: the time ended, or it was told to stop, before the trace was shortened.
  bool cut_short = false;
  /// leads_to: after so many firings of the trace, `p` holds.
  std::size_t turn = 0;
  Effort effort;
};

struct Count {
  bool complete = false;
  std::string why;             ///< reason if the count is not complete
  std::uint64_t markings = 0;  ///< reachable, or found so far
  std::uint64_t edges = 0;     ///< enabled transitions, summed over those markings
  Tokens most_tokens = 0;      ///< in any place of any marking
  Effort effort;
};
/// Counts the reachable markings.
[[nodiscard]] Count count(const PtNet& net, const Limits& limits);

/// Is a marking reachable in which `goal` is true? yes: with a shortest run to one.
[[nodiscard]] Answer find(const PtNet& net, const Formula& goal, const Limits& limits);

/// Is a dead marking reachable in which `is_final` is not true? yes: with a run to one, which is shortened
/// as far as a second search of limited cost allows. The cost is limited by steps.
///
/// Explores only a stubborn set of the enabled transitions of each marking, depth first.
/// Source: Valmari, stubborn sets for reduced state space generation (deadlock-preserving strong sets).
[[nodiscard]] Answer find_deadlock(const PtNet& net, const Formula& is_final, const Limits& limits);

/// Can a marking in which `goal` is true be reached from every reachable marking (AG EF)? no: with a
/// shortest run to a marking from which it cannot.
[[nodiscard]] Answer always_reachable(const PtNet& net, const Formula& goal, const Limits& limits);

/// After every reachable marking in which `p` is true, does `q` become true if every offered branch
/// is eventually taken? In other words: no run from there that avoids `q` ends where `q` can no longer
/// be reached. no: with a run that reaches `p` after `turn` firings and ends where `q` is out of
/// reach, without `q` in between.
[[nodiscard]] Answer leads_to(const PtNet& net, const Formula& p, const Formula& q, const Limits& limits);

/// From every reachable marking, some transition of the set can be fired at some time, unless ...
struct Obligation {
  std::vector<TransitionId> any_of;
  Formula unless = Formula::never();  ///< ... this formula is true there, or can be reached
};
/// One answer for each obligation, all from one graph. no: with a shortest run to a marking
/// where neither is possible.
[[nodiscard]] std::vector<Answer> can_always_fire(const PtNet& net,
                                                  const std::vector<Obligation>& obligations,
                                                  const Limits& limits);

/// The marking to which a run leads; nullopt: it is no run of the net.
[[nodiscard]] std::optional<Marking> replay(const PtNet& net, const std::vector<TransitionId>& firings);

}  // namespace tessera::explore
