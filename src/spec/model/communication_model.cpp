#include "spec/model/communication_model.hpp"

#include <algorithm>

namespace tessera::spec {
namespace {

std::uint32_t bits_of(const std::vector<std::uint32_t>& shared) {
  std::uint32_t bits = 0;
  for (const std::uint32_t place : shared) bits |= 1U << place;
  return bits;
}

/// The side alone, with `out` joined to its `in`. Removes the states from which every way comes to a stop.
class Rounds {
 public:
  Rounds(const CommunicationModel& model, const ModelSide& side)
      : side_(side), markings_(1U << model.shared.size()), goes_on_(side.places.size() * markings_, true) {}

  bool possible() {
    for (bool changed = true; changed;) {
      changed = false;
      for (std::uint32_t state = 0; state < goes_on_.size(); ++state)
        if (goes_on_[state] && stands(state)) {
          goes_on_[state] = false;
          changed = true;
        }
    }
    return std::ranges::find(goes_on_, true) != goes_on_.end();
  }

 private:
  [[nodiscard]] bool stands(std::uint32_t state) const {
    const std::uint32_t at = state / markings_, marking = state % markings_;
    if (at == ModelSide::out) return !goes_on_[ModelSide::in * markings_ + marking];
    return std::ranges::none_of(side_.transitions, [&](const ModelSide::Transition& transition) {
      const std::uint32_t takes = bits_of(transition.takes), gives = bits_of(transition.gives);
      if (transition.from != at || transition.elapsed || (marking & takes) != takes) return false;
      if ((marking & ~takes & gives) != 0) return false;  // no safe net has such a firing
      return goes_on_[transition.to * markings_ + ((marking & ~takes) | gives)];
    });
  }

  const ModelSide& side_;
  std::uint32_t markings_;
  std::vector<bool> goes_on_;  // per place and marking of the shared places
};

}  // namespace

bool ModelSide::has_timeout() const { return std::ranges::any_of(transitions, &Transition::elapsed); }

bool waits_without_peer(const CommunicationModel& model, const ModelSide& side) {
  return !Rounds(model, side).possible();
}

}  // namespace tessera::spec
