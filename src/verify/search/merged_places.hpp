#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "net/net.hpp"
#include "verify/search/merging.hpp"
#include "verify/search/surroundings.hpp"

namespace tessera::verify {

/// Places of some subsystems that count as one: where exactly its token is makes no difference to the others.
///
/// A behaviour *matters* if it uses a channel between the subsystems, if it has a place that is asked about, or if it
/// is one of few that give a value that is asked about. Behaviours that do not matter and follow each other count as
/// one place, if they are many: those of a dock that serve the other robots. Values of what a subsystem knows count as
/// one if no behaviour gives them that matters. The outcome of the last use of a channel to others is left out.
///
/// Places that count as one never hold two tokens together.
class MergedPlaces final : public Merging {
 public:
  /// asked: places that count for themselves. few: so many behaviours never count as one. Linear in the net.
  MergedPlaces(const net::Net& net, const Surroundings& surroundings,
               const std::set<net::SubsystemId>& subsystems, const std::set<net::PlaceId>& asked,
               std::size_t few);

  /// The place that stands for this one, mostly itself; an invalid one if it is left out.
  /// Precondition: surroundings.stays() is true for the place.
  [[nodiscard]] net::PlaceId operator[](net::PlaceId place) const override {
    return stands_for_[place.value];
  }
  /// Whether it counts as one with others, or is left out.
  [[nodiscard]] bool is_merged(net::PlaceId place) const override { return merged_[place.value]; }

 private:
  class Finder;
  std::vector<net::PlaceId> stands_for_;  // per place
  std::vector<bool> merged_;              // per place
};

}  // namespace tessera::verify
