#include "checks/binding.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace tessera::checks {
namespace {

constexpr std::size_t most_pairs = 2'000'000;

bool is_of_line(Number::Kind kind) {
  return kind == Number::Kind::laps || kind == Number::Kind::line_error || kind == Number::Kind::line_lost;
}

/// Looks elements up, for one i and one meaning of [*].
class Binder {
 public:
  explicit Binder(Scene& scene) : scene_(scene) {}

  void set_running(std::int64_t i) { running_ = i; }
  [[nodiscard]] const std::optional<Problem>& problem() const { return problem_; }

  BoundNumber number(const Number& written) {
    BoundNumber bound;
    bound.kind = written.kind;
    bound.value = written.value;
    bound.component = written.component;
    bound.text = text_of(written);
    for (const Number& part : written.parts) bound.parts.push_back(number(part));
    if (written.kind == Number::Kind::distance)
      bound.pairs = pairs(written.elements, Scene::As::point, Scene::As::point);
    else if (written.kind == Number::Kind::sensor)
      bind_sensor(written, bound);
    else if (!written.elements.empty())
      bind_element(written, is_of_line(written.kind) ? Scene::As::follower : Scene::As::point, bound);
    return bound;
  }

  BoundFormula formula(const Formula& written) {
    if (written.kind == Formula::Kind::every || written.kind == Formula::Kind::some)
      return quantified(written);
    BoundFormula bound;
    bound.kind = written.kind;
    for (const Number& side : written.numbers) bound.numbers.push_back(number(side));
    for (const Formula& part : written.parts) bound.parts.push_back(formula(part));
    if (written.kind == Formula::Kind::inside)
      bound.pairs = {pair_of(resolved(written.elements[0]), resolved(written.elements[1]), Scene::As::point,
                             Scene::As::zone)};
    if (written.kind == Formula::Kind::contact) bind_contact(written, bound);
    return bound;
  }

 private:
  void complain(std::string text) {
    if (!problem_) problem_ = Problem{std::move(text)};
  }

  void complain_of_group(const std::string& name) {
    std::string known;
    for (const std::string& group : scene_.groups()) known += (known.empty() ? "" : ", ") + group;
    complain("no model is placed as " + name + "[...]; " +
             (known.empty() ? "the world has none with a number" : "the world has: " + known));
  }

  /// An element of a thousand pairs is looked up once.
  std::size_t find(Scene::As as, const std::string& name) {
    const auto [known, is_new] = found_.try_emplace({as, name}, 0);
    if (!is_new) return known->second;
    const Result<std::size_t> found = scene_.find(as, name);
    if (!found) complain(found.problem());
    return known->second = found ? *found : 0;
  }

  /// The name without [i] and, within any(...) and all(...), without [*].
  std::string resolved(const Element& element) {
    Element plain = element;
    plain.index = Element::Index::constant;
    if (element.index == Element::Index::running) {
      plain.number = running_.value_or(0) + element.number;
      if (!running_) complain("[i] has no meaning here");
    } else if (element.index == Element::Index::every) {
      const auto meant = every_.find(element.name);
      if (meant == every_.end())
        complain(text_of(element) + " stands for many: write any(...) or all(...) around it");
      else
        plain.number = meant->second;
    } else {
      plain = element;
    }
    return text_of(plain);
  }
  void bind_element(const Number& written, Scene::As as, BoundNumber& bound) {
    const std::string name = resolved(written.elements.front());
    if (problem_) return;
    bound.element = find(as, name);
    Number plain = written;
    plain.elements.front() = Element();
    plain.elements.front().name = name;
    bound.text = text_of(plain);
  }

  /// All that an element stands for where the nearest pair counts.
  std::vector<std::string> all_of(const Element& element) {
    if (element.index != Element::Index::every || every_.contains(element.name)) return {resolved(element)};
    std::vector<std::string> names;
    Element plain = element;
    plain.index = Element::Index::constant;
    for (const std::int64_t index : scene_.indices_of(element.name)) {
      plain.number = index;
      names.push_back(text_of(plain));
    }
    if (names.empty()) complain_of_group(element.name);
    return names;
  }

  Pair pair_of(const std::string& first, const std::string& second, Scene::As as, Scene::As other) {
    if (problem_) return {};
    return {find(as, first), find(other, second), first + ", " + second};
  }

  /// Every pair once, and nothing with itself.
  std::vector<Pair> pairs(const std::vector<Element>& elements, Scene::As as, Scene::As other) {
    const std::vector<std::string> firsts = all_of(elements[0]), seconds = all_of(elements[1]);
    std::vector<Pair> found;
    if (firsts.size() * seconds.size() > most_pairs) complain("these are too many pairs");
    std::set<std::pair<std::string, std::string>> seen;
    for (const std::string& first : firsts)
      for (const std::string& second : seconds) {
        if (problem_) return {};
        if (first == second || !seen.insert(std::minmax(first, second)).second) continue;
        found.push_back(pair_of(first, second, as, other));
      }
    if (found.empty())
      complain(text_of(elements[0]) + " and " + text_of(elements[1]) + " are the same: there is no pair");
    return found;
  }

  void bind_contact(const Formula& written, BoundFormula& bound) {
    if (written.elements.size() == 2) {
      bound.pairs = pairs(written.elements, Scene::As::solid, Scene::As::solid);
      return;
    }
    bound.with_anything = true;
    for (const std::string& name : all_of(written.elements.front()))
      if (!problem_) bound.pairs.push_back({find(Scene::As::solid, name), 0, name});
  }

  void bind_sensor(const Number& written, BoundNumber& bound) {
    bind_element(written, Scene::As::sensor, bound);
    if (problem_) return;
    const std::size_t dimension = scene_.dimension_of(bound.element);
    const std::string name = text_of(written.elements.front());
    if (!written.has_component && dimension != 1)
      complain("sensor " + name + " gives " + std::to_string(dimension) + " numbers: write sensor(" + name +
               ", 0) for the first");
    if (written.component >= dimension)
      complain("sensor " + name + " gives " + std::to_string(dimension) + " numbers, counted from 0");
  }

  BoundFormula quantified(const Formula& written) {
    const Formula& part = written.parts.front();
    std::set<std::string> groups;
    collect_groups(part, groups);
    BoundFormula bound;
    bound.kind = written.kind;
    if (groups.size() != 1) {
      complain(groups.empty() ? "any(...) and all(...) need a [*] that is not one of a pair"
                              : "any(...) and all(...) range over one group: " + *groups.begin() + " or " +
                                    *std::next(groups.begin()));
      return bound;
    }
    const std::string group = *groups.begin();
    const std::vector<std::int64_t> indices = scene_.indices_of(group);
    if (indices.empty()) complain_of_group(group);
    for (const std::int64_t index : indices) {
      every_[group] = index;
      bound.parts.push_back(formula(part));
    }
    every_.erase(group);
    return bound;
  }

  /// The names X of X[*] that any(...) or all(...) gives a meaning; not both sides of a pair.
  void collect_groups(const Formula& written, std::set<std::string>& groups) const {
    collect_groups(written.elements, written.kind == Formula::Kind::contact, groups);
    for (const Formula& part : written.parts) collect_groups(part, groups);
    for (const Number& number : written.numbers) collect_groups(number, groups);
  }
  void collect_groups(const Number& written, std::set<std::string>& groups) const {
    collect_groups(written.elements, written.kind == Number::Kind::distance, groups);
    for (const Number& part : written.parts) collect_groups(part, groups);
  }
  void collect_groups(const std::vector<Element>& elements, bool pair, std::set<std::string>& groups) const {
    const auto is_every = [](const Element& element) { return element.index == Element::Index::every; };
    if (pair && elements.size() == 2 && std::ranges::all_of(elements, is_every)) return;
    for (const Element& element : elements)
      if (is_every(element) && !every_.contains(element.name)) groups.insert(element.name);
  }

  Scene& scene_;
  std::map<std::pair<Scene::As, std::string>, std::size_t> found_;
  std::optional<std::int64_t> running_;
  std::map<std::string, std::int64_t> every_;  ///< what X[*] means now
  std::optional<Problem> problem_;
};

/// For each group X of X[i+k], which k there are.
using Offsets = std::map<std::string, std::set<std::int64_t>>;

void collect(const std::vector<Element>& elements, Offsets& offsets) {
  for (const Element& element : elements)
    if (element.index == Element::Index::running) offsets[element.name].insert(element.number);
}
void collect(const Number& number, Offsets& offsets) {
  collect(number.elements, offsets);
  for (const Number& part : number.parts) collect(part, offsets);
}
void collect(const Formula& formula, Offsets& offsets) {
  collect(formula.elements, offsets);
  for (const Number& number : formula.numbers) collect(number, offsets);
  for (const Formula& part : formula.parts) collect(part, offsets);
}

/// The values of i for which every X[i+k] is there.
std::vector<std::int64_t> running_indices(const Offsets& offsets, const Scene& scene) {
  std::vector<std::int64_t> possible;
  const auto& [first, some] = *offsets.begin();
  for (const std::int64_t index : scene.indices_of(first)) possible.push_back(index - *some.begin());
  for (const auto& [name, numbers] : offsets) {
    const std::vector<std::int64_t> there = scene.indices_of(name);
    std::erase_if(possible, [&, &wanted = numbers](std::int64_t i) {
      return !std::ranges::all_of(
          wanted, [&](std::int64_t offset) { return std::ranges::binary_search(there, i + offset); });
    });
  }
  return possible;
}

}  // namespace

Result<BoundFormulas> bind(const Formula& formula, Scene& scene) {
  Offsets offsets;
  collect(formula, offsets);
  BoundFormulas bound;
  bound.has_index = !offsets.empty();
  const std::vector<std::int64_t> indices =
      bound.has_index ? running_indices(offsets, scene) : std::vector<std::int64_t>{0};
  if (indices.empty())
    return Problem{"there is no i for which all of " + offsets.begin()->first + "[i] is there"};
  for (const std::int64_t i : indices) {
    Binder binder(scene);
    if (bound.has_index) binder.set_running(i);
    bound.by_index.emplace_back(i, binder.formula(formula));
    if (binder.problem()) return *binder.problem();
  }
  return bound;
}

Result<BoundNumber> bind(const Number& number, Scene& scene) {
  Binder binder(scene);
  BoundNumber bound = binder.number(number);
  if (binder.problem()) return *binder.problem();
  return bound;
}

}  // namespace tessera::checks
