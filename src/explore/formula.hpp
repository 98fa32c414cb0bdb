#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "explore/pt_net.hpp"

namespace tessera::explore {

/// A statement about one marking.
struct Formula {
  enum class Kind : std::uint8_t {
    at_least,  ///< place holds `tokens` or more
    enabled,   ///< the transition is enabled
    dead,      ///< no transition is enabled
    negation,  ///< negation of the only part
    all,       ///< all parts hold; true if there are none
    any        ///< at least one part holds; false if there are none
  } kind = Kind::all;
  std::uint32_t node = 0;  ///< place or transition
  Tokens tokens = 1;
  std::vector<Formula> parts;

  [[nodiscard]] static Formula at_least(PlaceId place, Tokens tokens) {
    return {Kind::at_least, place.value, tokens, {}};
  }
  [[nodiscard]] static Formula marked(PlaceId place) { return at_least(place, 1); }
  [[nodiscard]] static Formula enabled(TransitionId transition) {
    return {Kind::enabled, transition.value, 1, {}};
  }
  [[nodiscard]] static Formula dead() { return {Kind::dead, 0, 1, {}}; }
  [[nodiscard]] static Formula negation(Formula part) { return {Kind::negation, 0, 1, {std::move(part)}}; }
  [[nodiscard]] static Formula all(std::vector<Formula> parts) { return {Kind::all, 0, 1, std::move(parts)}; }
  [[nodiscard]] static Formula any(std::vector<Formula> parts) { return {Kind::any, 0, 1, std::move(parts)}; }
  [[nodiscard]] static Formula always() { return all({}); }
  [[nodiscard]] static Formula never() { return any({}); }
};

/// Whether the formula is true in the marking. Preconditions: places and transitions belong to the net.
[[nodiscard]] bool holds(const Formula& formula, const PtNet& net, std::span<const Tokens> marking);

}  // namespace tessera::explore
