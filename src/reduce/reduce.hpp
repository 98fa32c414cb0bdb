#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "net/net.hpp"

/// Structural reductions of place/transition nets: a smaller net with the same answers.
namespace tessera::reduce {

/// Facts that the reduced net must preserve, besides whether there is a dead marking.
struct Preserve {
  /// Formulas over the tokens of these places: the reduced net reaches the same combinations of them.
  std::vector<net::PlaceId> observed{};
  /// For each set, whether from every reachable marking some continuation fires one of its transitions.
  std::vector<std::vector<net::TransitionId>> sets{};
  /// The net is known to be safe (no place ever holds two tokens), which allows more reductions.
  bool safe = false;
};

/// Each rule can be switched off. "Untouched" means: touches no observed place.
struct Rules {
  /// A transition with an input place that never gets enough tokens.
  bool dead_transitions = true;
  /// One of two transitions with the same effect and the same needs.
  bool parallel_transitions = true;
  /// A transition without effect, in no set, if another transition is enabled whenever it is.
  bool identity_transitions = true;
  /// A place from which no transition takes.
  bool sink_places = true;
  /// A place that no firing lowers and that holds enough tokens from the start.
  bool constant_places = true;
  /// A place that always holds at least as many tokens as another place of which at least as many are needed
  /// (Berthelot: an implicit place; here with one other place).
  bool implicit_places = true;
  /// A marked place that no transition fills and that one transition empties. If that transition has no other
  /// input and is untouched, it is fired at once.
  bool start = true;
  /// An unmarked place whose consumers have no other input and are untouched. A transition that fills it is
  /// fired together with one that empties it (Berthelot; Thierry-Mieg, *Structural reductions revisited*,
  /// Petri Nets 2020).
  bool post_agglomeration = true;
  /// An unmarked place whose only producer fills no other place, shares no input place and is untouched. The
  /// producer is delayed until its token is needed. Only if the producer is in no set, or the net is safe.
  bool pre_agglomeration = true;
};

struct NamedRule {
  const char* name;  ///< as the member is called
  bool Rules::*on;
};
/// In the order of Rules.
[[nodiscard]] std::span<const NamedRule> named_rules();
/// Switches a rule off, or "all" of them; false: there is no such rule.
[[nodiscard]] bool switch_off(Rules& rules, std::string_view name);

struct Statistics {
  std::size_t places_before = 0, transitions_before = 0;
  std::size_t places_after = 0, transitions_after = 0;
  /// Transitions whose condition never holds; they are always left out.
  std::size_t impossible_transitions = 0;
  /// How often each rule was applied, in the order of Rules.
  std::size_t dead_transitions = 0, parallel_transitions = 0, identity_transitions = 0;
  std::size_t sink_places = 0, constant_places = 0, implicit_places = 0;
  std::size_t start = 0, post_agglomeration = 0, pre_agglomeration = 0;
};

/// A firing sequence as a tree: an original transition (without a second), or one sequence after another.
struct Sequence {
  std::uint32_t first = 0;
  std::optional<std::uint32_t> second{};
};

/// A smaller net and the way back. Observed places keep their numbers of tokens, and remaining places keep
/// their bounds. Whether a removed place was safe is lost.
class Reduced {
 public:
  net::Net net;
  /// Per set of Preserve::sets: the transitions that stand for one of the set, among others.
  std::vector<std::vector<net::TransitionId>> sets;
  Statistics statistics;

  /// The place that stands for a place of the original net; nullopt if it is gone.
  [[nodiscard]] std::optional<net::PlaceId> find(net::PlaceId original) const;

  /// A firing sequence of the original net for one of the reduced net. It leads to a marking with the same
  /// tokens in every observed place, and to a dead one if the given sequence does.
  [[nodiscard]] std::vector<net::TransitionId> lift(std::span<const net::TransitionId> trace) const;

 private:
  friend Reduced reduce(const net::Net& net, const Preserve& what, const Rules& on);

  void append(std::uint32_t sequence, std::vector<net::TransitionId>& to) const;
  void settle(std::vector<net::TransitionId>& trace) const;

  const net::Net* original_ = nullptr;
  std::vector<net::PlaceId> place_of_;  // per original place; none: it is gone
  std::vector<Sequence> sequences_;     // the first ones are the original transitions
  std::vector<std::uint32_t> fires_;    // per transition of `net`: a sequence
  std::vector<std::uint32_t> start_;    // sequences fired at once
  std::vector<std::uint32_t> delayed_;  // sequences that pre-agglomeration put off, in the order of the rules
};

/// Applies the rules until none applies any more.
///
/// Preserved: whether a dead marking is reachable, and `what`. Not preserved: lengths of traces, number of
/// markings. The result refers to `net`, which must outlive it.
///
/// Threads: pure. Linear in the net. Places and transitions with very many arcs are tried less often.
/// Source:  Berthelot, *Transformations and decompositions of nets*, 1987; Thierry-Mieg 2020. Proofs of the
///          deviations: docs/theory/reductions.md.
[[nodiscard]] Reduced reduce(const net::Net& net, const Preserve& what, const Rules& on = {});

}  // namespace tessera::reduce
