// Rows: the latest of each event that the next occurrence of another one needs.
#pragma once

#include <cstdint>
#include <vector>

#include "timing/occurrences.hpp"

namespace tessera::timing {

/// Longest paths in a component of the event graph, for one pass of its bounds.
class Rows {
 public:
  Rows(Occurrences& bounds, Occurrences::Component& component) : bounds_(bounds), component_(component) {}

  /// Lowers the rows of the component, and the gaps of its events.
  void find();

 private:
  /// Time from x. held: over paths through a wait only; `never` if there is none.
  struct Latest {
    Time any, held;
  };
  static constexpr Time never = -unbounded;

  void find_row(EventId x, std::vector<Time>& row);
  [[nodiscard]] Latest at_release(EventId y, EventId x) const;
  [[nodiscard]] Latest at_event(EventId y, EventId x) const;
  [[nodiscard]] Time occurrence(EventId b, EventId y, EventId x, bool around) const;
  void count_tokens_to(EventId x);
  [[nodiscard]] bool counts_are_fixed();
  [[nodiscard]] Time all_work() const;
  [[nodiscard]] std::uint32_t tokens(EventId y) const { return tokens_[bounds_.place_in_[y]]; }
  [[nodiscard]] bool is_mine(EventId y) const { return bounds_.same_component(y, component_.events.front()); }

  Occurrences& bounds_;
  Occurrences::Component& component_;
  std::vector<std::uint32_t> tokens_;  ///< by place: fewest on a path to the present x
  std::vector<Latest> latest_;         ///< by place
};

}  // namespace tessera::timing
