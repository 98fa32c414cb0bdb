#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "checks/expression.hpp"
#include "checks/scene.hpp"

/// Formulas and numbers whose elements were looked up, with nothing left of [*] and [i].
namespace tessera::checks {

/// Two elements of a scene.
struct Pair {
  std::size_t first = 0, second = 0;
  std::string names;  ///< "robot[0], robot[3]", for people
};

struct BoundNumber {
  Number::Kind kind = Number::Kind::literal;
  double value = 0;
  std::vector<Pair> pairs;    ///< of a distance: the nearest one counts
  std::size_t element = 0;    ///< of what is no distance
  std::size_t component = 0;  ///< of a sensor
  std::vector<BoundNumber> parts;
  std::string text;  ///< for people
};

struct BoundFormula {
  Formula::Kind kind = Formula::Kind::less;
  std::vector<BoundNumber> numbers;
  std::vector<Pair> pairs;  ///< of contact: one of them suffices
  bool with_anything = false;
  std::vector<BoundFormula> parts;  ///< of every and some: one for each that [*] stands for
};

/// One formula for each i whose elements all exist; a single one if the text has no [i].
struct BoundFormulas {
  std::vector<std::pair<std::int64_t, BoundFormula>> by_index;
  bool has_index = false;
};

/// Problem: an element does not exist, or [*] stands where it has no meaning.
[[nodiscard]] Result<BoundFormulas> bind(const Formula& formula, Scene& scene);
/// A measure has no [i], and a [*] only in a distance.
[[nodiscard]] Result<BoundNumber> bind(const Number& number, Scene& scene);

[[nodiscard]] double value_of(const BoundNumber& number, Scene& scene);
[[nodiscard]] bool holds(const BoundFormula& formula, Scene& scene);
/// The quantity of a check, for a plot: for a comparison with a constant the other side (the worst of all i),
/// for any other check 1 if it holds and 0 if not. forbids: the check demands that the formula never holds.
struct Shown {
  double value = 0;
  std::optional<double> limit;  ///< of a comparison
};
[[nodiscard]] Shown shown(const BoundFormulas& formulas, bool forbids, Scene& scene);
/// The facts on which a formula depends: "distance(a, b) = 0.183", "robot[0], robot[3] touch". At most three.
[[nodiscard]] std::string facts_of(const BoundFormula& formula, Scene& scene);

}  // namespace tessera::checks
