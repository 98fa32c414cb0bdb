#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "net/net.hpp"

/// Explicit exploration of place/transition nets: counting, searching, and what can always be reached.
namespace tessera::explore {

using net::PlaceId;
using net::TransitionId;

using Tokens = std::uint32_t;
/// Tokens per place, in the order of the net.
using Marking = std::vector<Tokens>;

/// One end of the arcs between a transition and a place it touches.
struct Touch {
  std::uint32_t node = 0;  ///< the place (seen from a transition) or the transition (seen from a place)
  Tokens consumes = 0;     ///< weight from place to transition
  Tokens produces = 0;     ///< weight from transition to place

  [[nodiscard]] std::int64_t effect() const { return std::int64_t{produces} - std::int64_t{consumes}; }
};

/// A net compiled for exploration: arcs in compressed rows, by transition and by place.
///
/// Threads: const members from any thread.
class PtNet {
 public:
  explicit PtNet(const net::Net& net);
  // The rows refer to touches_: those of a copy would refer to the original.
  PtNet(const PtNet&) = delete;
  PtNet& operator=(const PtNet&) = delete;
  PtNet(PtNet&&) = delete;
  PtNet& operator=(PtNet&&) = delete;
  ~PtNet() = default;

  [[nodiscard]] std::uint32_t places() const { return static_cast<std::uint32_t>(initial_.size()); }
  [[nodiscard]] std::uint32_t transitions() const {
    return static_cast<std::uint32_t>(of_transition_.size());
  }
  [[nodiscard]] const Marking& initial() const { return initial_; }
  /// The places that a transition touches, each once.
  [[nodiscard]] std::span<const Touch> of_transition(std::uint32_t transition) const {
    return of_transition_[transition];
  }
  /// The transitions that touch a place, each once.
  [[nodiscard]] std::span<const Touch> of_place(std::uint32_t place) const { return of_place_[place]; }

  [[nodiscard]] bool enabled(std::uint32_t transition, std::span<const Tokens> marking) const;
  /// Precondition: enabled, and no place grows beyond what Tokens holds.
  void fire(std::uint32_t transition, std::span<Tokens> marking) const;

 private:
  Marking initial_;
  std::vector<Touch> touches_;
  std::vector<std::span<const Touch>> of_transition_, of_place_;  // into touches_
};

}  // namespace tessera::explore
