#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reduce/reduce.hpp"

namespace tessera::reduce {

using net::Arc;
using Arcs = std::vector<Arc>;  ///< in the order of their places

/// A net from which elements can be removed. The numbers of places and transitions stay valid;
/// removed elements are not alive.
class Draft {
 public:
  struct Place {
    std::uint32_t tokens = 0;
    bool observed = false, alive = true;
    std::vector<std::uint32_t> producers{}, consumers{};  ///< transitions, in any order
  };
  struct Transition {
    Arcs inputs{}, outputs{};
    std::uint32_t sequence = 0;         ///< the sequence that it fires
    std::vector<std::uint32_t> sets{};  ///< of Preserve::sets, sorted
    bool alive = true;
  };

  Draft(const net::Net& net, const Preserve& what);

  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  [[nodiscard]] const std::vector<Transition>& transitions() const { return transitions_; }
  [[nodiscard]] bool touches_observed(const Transition& transition) const;

  void add(Transition transition);
  void remove_place(std::uint32_t place);
  void remove_transition(std::uint32_t transition);
  void add_to_sets(std::uint32_t transition, const std::vector<std::uint32_t>& sets);
  /// Moves the tokens of one firing. The caller removes the transition next, which reopens its places.
  void fire(std::uint32_t transition);

  /// A place that changed and may now be reduced; nullopt: none is left.
  std::optional<std::uint32_t> next_place() { return take(open_places_, place_is_open_); }
  std::optional<std::uint32_t> next_transition() { return take(open_transitions_, transition_is_open_); }

 private:
  static std::optional<std::uint32_t> take(std::vector<std::uint32_t>& open, std::vector<bool>& is_open);
  static void put(std::uint32_t item, std::vector<std::uint32_t>& open, std::vector<bool>& is_open);
  void touch(const Transition& transition);

  std::vector<Place> places_;
  std::vector<Transition> transitions_;
  std::vector<std::uint32_t> open_places_, open_transitions_;
  std::vector<bool> place_is_open_, transition_is_open_;
};

/// The rules that look at neighbours skip places and transitions with more arcs than this, so that the work
/// stays linear in the net: in a fleet, one transition is connected to all pages.
inline constexpr std::size_t most_arcs = 24;
[[nodiscard]] inline bool is_small(const Draft::Transition& transition) {
  return transition.inputs.size() + transition.outputs.size() <= most_arcs;
}

/// Weight of the arc at a place, 0 if there is none.
[[nodiscard]] std::uint32_t weight_at(const Arcs& arcs, std::uint32_t place);
/// The union of two lists of arcs; weights of the same place are added.
[[nodiscard]] Arcs sum(const Arcs& a, const Arcs& b);
[[nodiscard]] Arcs without(const Arcs& arcs, std::uint32_t place);
[[nodiscard]] std::vector<std::uint32_t> united(const std::vector<std::uint32_t>& a,
                                                const std::vector<std::uint32_t>& b);

/// The data that all rules share: the draft, and the way back to the original net.
struct Work {
  Draft& draft;
  const Preserve& what;
  const Rules& on;
  Statistics& count;
  std::vector<Sequence>& sequences;  ///< one after another
  std::vector<std::uint32_t>& start;
  std::vector<std::uint32_t>& delayed;
};

/// Each function applies its rules to one place or transition that is alive. true: something was removed.
bool reduce_place(Work& work, std::uint32_t place);
bool agglomerate(Work& work, std::uint32_t place);
bool reduce_transition(Work& work, std::uint32_t transition);

}  // namespace tessera::reduce
