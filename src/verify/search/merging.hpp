#pragma once

#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// Places of a part that count as one: where exactly their token is makes no difference to the question.
///
/// Places that count as one never hold two tokens together.
class Merging {
 public:
  /// A step between places, as they are counted, for any number of transitions. It takes a place that counts as one.
  struct Step {
    std::vector<net::PlaceId> in{}, out{};
  };

  Merging() = default;
  virtual ~Merging() = default;
  Merging(const Merging&) = delete;
  Merging& operator=(const Merging&) = delete;
  Merging(Merging&&) = delete;
  Merging& operator=(Merging&&) = delete;

  /// The place that stands for this one, mostly itself; an invalid one if it is left out. It may be one that the net
  /// does not have. Precondition: the place stays in the part (Surroundings::stays).
  [[nodiscard]] virtual net::PlaceId operator[](net::PlaceId place) const = 0;
  /// Whether it counts as one with others, or is left out.
  [[nodiscard]] virtual bool is_merged(net::PlaceId place) const = 0;
  /// Transitions of a subsystem of the part that are not among `steps`; nullptr: all.
  [[nodiscard]] virtual const std::vector<net::TransitionId>* transitions(net::SubsystemId /*one*/) const {
    return nullptr;
  }
  [[nodiscard]] virtual const std::vector<Step>& steps() const { return none_; }
  /// Places of these steps' transitions that may hold a token first.
  [[nodiscard]] virtual const std::vector<net::PlaceId>& filled() const { return no_places_; }

 private:
  std::vector<Step> none_{};
  std::vector<net::PlaceId> no_places_{};
};

}  // namespace tessera::verify
