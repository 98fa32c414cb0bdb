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

/// What the reduced net has to keep, besides whether there is a dead marking.
struct Preserve {
  /// Formulas over the tokens of these places: the reduced net reaches the same combinations of them.
  std::vector<net::PlaceId> observed{};
  /// For each set, whether from every reachable marking some continuation fires one of its transitions.
  std::vector<std::vector<net::TransitionId>> sets{};
  /// Known to be safe (no place ever holds two tokens); allows more.
  bool safe = false;
};

/// Each rule can be switched off. "Untouched" means: touches no observed place.
struct Rules {
  /// A transition with an input place that never gets enough tokens.
  bool dead_transitions = true;
  /// Of two transitions with the same effect and the same needs, one.
  bool parallel_transitions = true;
  /// A transition without effect that is in no set, if another one is enabled whenever it is.
  bool identity_transitions = true;
  /// A place from which nothing is taken.
  bool sink_places = true;
  /// A place that no firing lowers and that holds enough tokens from the start.
  bool constant_places = true;
  /// A place that always holds at least as many tokens as another one that is asked for at least as many
  /// (Berthelot: an implicit place; here with one other place).
  bool implicit_places = true;
  /// A marked place that nothing fills and that one transition empties, which needs nothing else and is
  /// untouched: the transition is fired at once.
  bool start = true;
  /// An unmarked place whose consumers need nothing else and are untouched: what fills it is fired together
  /// with what empties it (Berthelot; Thierry-Mieg, *Structural reductions revisited*, Petri Nets 2020).
  bool post_agglomeration = true;
  /// An unmarked place whose one producer fills nothing else, competes with nobody and is untouched: it is
  /// delayed until its token is needed. Only if the producer is in no set, or the net is safe.
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

/// A smaller net and the way back. Observed places keep their number of tokens; places that are left keep
/// their bound; whether a place that is gone was safe is not kept.
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

  /// A firing sequence as a tree: an original transition (second is invalid), or one sequence after another.
  struct Sequence {
    std::uint32_t first = 0, second = UINT32_MAX;
  };
  void append(std::uint32_t sequence, std::vector<net::TransitionId>& to) const;
  void settle(std::vector<net::TransitionId>& trace) const;

  const net::Net* original_ = nullptr;
  std::vector<std::uint32_t> place_of_;  // per original place
  std::vector<Sequence> sequences_;      // the first ones are the original transitions
  std::vector<std::uint32_t> fires_;     // per transition of `net`: a sequence
  std::vector<std::uint32_t> start_;     // sequences fired at once
  std::vector<std::uint32_t> delayed_;  // sequences that pre-agglomeration put off, in the order of the rules
};

/// Applies the rules until none applies any more.
///
/// Preserved: whether a dead marking is reachable; Preserve. Not preserved: lengths of traces, the number of
/// markings. The result refers to `net`, which must outlive it. Threads: pure. Linear in the net but for
/// places and transitions with very many arcs, which are looked at less often. Source: Berthelot,
/// *Transformations and decompositions of nets*, 1987; Thierry-Mieg 2020. Proofs of the deviations:
/// docs/reductions.md.
[[nodiscard]] Reduced reduce(const net::Net& net, const Preserve& what, const Rules& on = {});

}  // namespace tessera::reduce
