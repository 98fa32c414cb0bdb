#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "checks/binding.hpp"

namespace tessera::checks {
namespace {

double distance_of(const Pair& pair, Scene& scene) {
  const auto a = scene.position(pair.first), b = scene.position(pair.second);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double least_distance(const std::vector<Pair>& pairs, Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const Pair& pair : pairs) least = std::min(least, distance_of(pair, scene));
  return least;
}

bool touches(const BoundFormula& formula, const Pair& pair, Scene& scene) {
  return formula.with_anything ? scene.touched_anything(pair.first) : scene.touched(pair.first, pair.second);
}

bool compare(const BoundFormula& formula, Scene& scene) {
  const double left = value_of(formula.numbers[0], scene), right = value_of(formula.numbers[1], scene);
  switch (formula.kind) {
    case Formula::Kind::less:
      return left < right;
    case Formula::Kind::less_or_equal:
      return left <= right;
    case Formula::Kind::greater:
      return left > right;
    default:
      return left >= right;
  }
}

const char* unit_of(Number::Kind kind) {
  switch (kind) {
    case Number::Kind::height:
    case Number::Kind::line_error:
      return " m";
    case Number::Kind::speed:
      return " m/s";
    case Number::Kind::line_lost:
      return " s";
    default:
      return "";
  }
}

/// Collects facts, up to a number that people still read.
class Facts {
 public:
  explicit Facts(Scene& scene) : scene_(scene) {}
  void collect(const BoundFormula& formula) {
    for (const BoundNumber& number : formula.numbers) collect(number);
    if (formula.kind == Formula::Kind::contact) collect_contacts(formula);
    if (formula.kind == Formula::Kind::inside)
      add(fmt::format("inside({}) is {}", formula.pairs.front().names, holds(formula, scene_)));
    for (const BoundFormula& part : formula.parts) {
      // Among many equal ones, only the decisive ones are reported.
      if (formula.kind == Formula::Kind::every && holds(part, scene_)) continue;
      if (formula.kind == Formula::Kind::some && !holds(part, scene_)) continue;
      collect(part);
    }
  }
  [[nodiscard]] std::string text() const { return text_; }

 private:
  void add(const std::string& fact) {
    if (++count_ <= 3) text_ += (text_.empty() ? "" : "; ") + fact;
  }
  void collect(const BoundNumber& number) {
    for (const BoundNumber& part : number.parts) collect(part);
    if (number.kind == Number::Kind::distance) {
      const Pair& nearest = *std::ranges::min_element(
          number.pairs, {}, [&](const Pair& pair) { return distance_of(pair, scene_); });
      add(fmt::format("distance({}) = {:.6g} m", nearest.names, distance_of(nearest, scene_)));
    } else if (number.kind != Number::Kind::literal && number.parts.empty()) {
      add(fmt::format("{} = {:.6g}{}", number.text, value_of(number, scene_), unit_of(number.kind)));
    }
  }
  void collect_contacts(const BoundFormula& formula) {
    bool any = false;
    for (const Pair& pair : formula.pairs) {
      if (!touches(formula, pair, scene_)) continue;
      any = true;
      add(formula.with_anything ? pair.names + " touches something" : pair.names + " touch");
    }
    if (!any) add("nothing touches");
  }

  Scene& scene_;
  std::string text_;
  int count_ = 0;
};

}  // namespace

double value_of(const BoundNumber& number, Scene& scene) {
  switch (number.kind) {
    case Number::Kind::literal:
      return number.value;
    case Number::Kind::distance:
      return least_distance(number.pairs, scene);
    case Number::Kind::height:
      return scene.position(number.element)[2];
    case Number::Kind::speed:
      return scene.speed(number.element);
    case Number::Kind::sensor:
      return scene.sensor(number.element, number.component);
    case Number::Kind::laps:
      return scene.on_line(number.element).laps;
    case Number::Kind::line_error:
      return scene.on_line(number.element).error_m;
    case Number::Kind::line_lost:
      return scene.on_line(number.element).lost_s;
    case Number::Kind::sum:
      return value_of(number.parts[0], scene) + value_of(number.parts[1], scene);
    case Number::Kind::difference:
      return value_of(number.parts[0], scene) - value_of(number.parts[1], scene);
    case Number::Kind::product:
      return value_of(number.parts[0], scene) * value_of(number.parts[1], scene);
    case Number::Kind::quotient:
      return value_of(number.parts[0], scene) / value_of(number.parts[1], scene);
    case Number::Kind::negative:
      return -value_of(number.parts[0], scene);
  }
  return 0;
}

bool holds(const BoundFormula& formula, Scene& scene) {
  const auto part_holds = [&](const BoundFormula& part) { return holds(part, scene); };
  switch (formula.kind) {
    case Formula::Kind::contact:
      return std::ranges::any_of(formula.pairs,
                                 [&](const Pair& pair) { return touches(formula, pair, scene); });
    case Formula::Kind::inside:
      return scene.inside(formula.pairs.front().first, formula.pairs.front().second);
    case Formula::Kind::negation:
      return !holds(formula.parts.front(), scene);
    case Formula::Kind::both:
    case Formula::Kind::every:
      return std::ranges::all_of(formula.parts, part_holds);
    case Formula::Kind::either:
    case Formula::Kind::some:
      return std::ranges::any_of(formula.parts, part_holds);
    default:
      return compare(formula, scene);
  }
}

std::string facts_of(const BoundFormula& formula, Scene& scene) {
  Facts facts(scene);
  facts.collect(formula);
  return facts.text();
}

namespace {

/// The side that is no constant, and whether less of it is better. nullopt: it is no such comparison.
struct Side {
  const BoundNumber *number, *limit;
  bool wants_less;
};
std::optional<Side> side_of(const BoundFormula& formula) {
  const bool less = formula.kind == Formula::Kind::less || formula.kind == Formula::Kind::less_or_equal;
  const bool greater =
      formula.kind == Formula::Kind::greater || formula.kind == Formula::Kind::greater_or_equal;
  if (!less && !greater) return std::nullopt;
  const BoundNumber &left = formula.numbers[0], &right = formula.numbers[1];
  if (right.kind == Number::Kind::literal) return Side{&left, &right, less};
  if (left.kind == Number::Kind::literal) return Side{&right, &left, greater};
  return std::nullopt;
}

}  // namespace

Shown shown(const BoundFormulas& formulas, bool forbids, Scene& scene) {
  std::optional<Shown> worst;
  bool all = true, any = false;
  for (const auto& [i, formula] : formulas.by_index) {
    const std::optional<Side> side = side_of(formula);
    if (!side) {
      const bool now = holds(formula, scene);
      all = all && now;
      any = any || now;
      continue;
    }
    const double value = value_of(*side->number, scene);
    const bool greatest_is_worst = side->wants_less != forbids;
    if (!worst || (greatest_is_worst ? value > worst->value : value < worst->value))
      worst = Shown{value, side->limit->value};
  }
  return worst.value_or(Shown{(forbids ? any : all) ? 1.0 : 0.0, std::nullopt});
}

}  // namespace tessera::checks
