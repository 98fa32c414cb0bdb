#pragma once

#include <optional>
#include <span>
#include <vector>

#include "explore/formula.hpp"
#include "net/net.hpp"
#include "reduce/components.hpp"

namespace tessera::verify {

/// Some components of a net as a net of their own.
class Part {
 public:
  Part(const net::Net& net, std::span<const reduce::Component* const> components);

  [[nodiscard]] const net::Net& net() const { return part_; }
  /// A formula over places of the whole net, in terms of the part. Precondition: its places are in the part.
  [[nodiscard]] explore::Formula inside(explore::Formula formula) const;
  /// Transitions of the part, as transitions of the whole net.
  [[nodiscard]] std::vector<net::TransitionId> outside(const std::vector<net::TransitionId>& trace) const;

 private:
  net::Net part_;
  std::vector<net::PlaceId> place_of_;       // per place of the whole net
  std::vector<net::TransitionId> original_;  // per transition of the part
};

/// The places that a formula asks about.
void places_of(const explore::Formula& formula, std::vector<net::PlaceId>& to);

}  // namespace tessera::verify
