#include "checks/parser.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "checks/text_reader.hpp"
#include "tessera/nearest.hpp"

namespace tessera::checks {
namespace {

constexpr std::uint32_t deepest = 64;
constexpr const char* formula_hint =
    "for example contact(robot[*], robot[*]), inside(box[0], bin) or distance(a, b) > 0.2 m";
constexpr std::string_view functions =
    "distance, height, speed, sensor, contact, inside, laps, line_error and line_lost";

struct Function {
  std::string_view name;
  std::size_t least, most;  ///< arguments
};
struct NumberFunction : Function {
  Number::Kind kind;
  std::string_view unit;  ///< empty: it is not known
};
constexpr std::array number_functions = {NumberFunction{{"distance", 2, 2}, Number::Kind::distance, "m"},
                                         NumberFunction{{"height", 1, 1}, Number::Kind::height, "m"},
                                         NumberFunction{{"speed", 1, 1}, Number::Kind::speed, "m/s"},
                                         NumberFunction{{"sensor", 1, 1}, Number::Kind::sensor, ""},
                                         NumberFunction{{"laps", 1, 1}, Number::Kind::laps, "1"},
                                         NumberFunction{{"line_error", 1, 1}, Number::Kind::line_error, "m"},
                                         NumberFunction{{"line_lost", 1, 1}, Number::Kind::line_lost, "s"}};
constexpr std::array formula_functions = {Function{"contact", 1, 2}, Function{"inside", 2, 2}};

/// A recursive descent parser.
class Parser : private TextReader {
 public:
  Parser(std::string_view text, const Units& units) : TextReader(text), units_(units) {}

  Parsed<Formula> whole_formula() { return whole(disjunction()); }
  Parsed<Number> whole_number() { return whole(sum()); }

 private:
  template <class T>
  Parsed<T> whole(T read) {
    if (!rest().empty()) unexpected();
    if (mistake_) return {std::nullopt, std::move(*mistake_)};
    return {std::move(read), {}};
  }

  void unexpected() {
    const std::string_view left = rest();
    if (left.empty())
      return fail({text_.empty() ? 0 : text_.size() - 1, 1}, "the text ends too early", formula_hint);
    for (const auto& [symbol, meant] : {std::pair<std::string_view, std::string_view>{"&&", "and"},
                                        {"||", "or"},
                                        {"!", "not"},
                                        {"==", "<= or >="}})
      if (left.starts_with(symbol))
        return fail({at_, symbol.size()}, "'" + std::string(symbol) + "' is not known here",
                    "write " + std::string(meant));
    std::string_view found = word();
    if (found.empty()) found = left.substr(0, 1);
    fail({at_, found.size()}, "unexpected '" + std::string(found) + "'", formula_hint);
  }

  /// Counts how deep the brackets are.
  class Level {
   public:
    explicit Level(Parser& parser) : parser_(parser) {
      if (++parser.depth_ > deepest)
        parser.fail({parser.at_, 1}, "the text is nested too deeply", "use fewer brackets");
    }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    ~Level() { --parser_.depth_; }

   private:
    Parser& parser_;
  };

  // ------------------------------------------------------------------------------------------ formulas

  using Rule = Formula (Parser::*)();
  Formula joined(std::string_view by, Formula::Kind kind, Rule rule) {
    const std::size_t from = at_;
    Formula first = (this->*rule)();
    if (word() != by) return first;
    Formula all;
    all.kind = kind;
    all.parts.push_back(std::move(first));
    while (take_word(by)) all.parts.push_back((this->*rule)());
    all.place = since(from);
    return all;
  }
  Formula disjunction() { return joined("or", Formula::Kind::either, &Parser::conjunction); }
  Formula conjunction() { return joined("and", Formula::Kind::both, &Parser::negation); }

  Formula around(Formula::Kind kind, std::size_t from, Formula part) {
    Formula formula;
    formula.kind = kind;
    formula.parts.push_back(std::move(part));
    formula.place = since(from);
    return formula;
  }

  Formula negation() {
    const Level level(*this);
    static_cast<void>(rest());
    const std::size_t from = at_;
    if (take_word("not")) return around(Formula::Kind::negation, from, negation());
    if (take_word("any")) return around(Formula::Kind::some, from, quantified("any", from));
    if (take_word("all")) return around(Formula::Kind::every, from, quantified("all", from));
    for (const Function& function : formula_functions)
      if (take_word(function.name)) return predicate(function, from);
    if (rest().starts_with('(')) return bracketed_or_comparison();
    return comparison();
  }

  Formula quantified(std::string_view word, std::size_t from) {
    if (!take("("))
      fail({from, word.size()}, "'" + std::string(word) + "' needs brackets",
           std::string(word) + "(inside(box[*], bin))");
    return closed();
  }
  Formula closed() {
    Formula inside = disjunction();
    if (!take(")")) unexpected();
    return inside;
  }

  /// A bracket may hold a formula, or a number that is compared: both are tried.
  Formula bracketed_or_comparison() {
    const std::size_t from = at_;
    take("(");
    Formula inside = closed();
    if (!mistake_ && !continues_number()) return inside;
    const std::optional<Mistake> why_no_formula = std::exchange(mistake_, std::nullopt);
    at_ = from;
    Formula compared = comparison();
    // The mistake that was met later is the one that was made.
    if (mistake_ && why_no_formula && why_no_formula->place.offset >= mistake_->place.offset)
      mistake_ = why_no_formula;
    return compared;
  }
  bool continues_number() {
    const std::string_view left = rest();
    return !left.empty() && std::string_view("+-*/<>").find(left.front()) != std::string_view::npos;
  }

  Formula predicate(const Function& function, std::size_t from) {
    Formula formula;
    formula.kind = function.name == "contact" ? Formula::Kind::contact : Formula::Kind::inside;
    formula.elements = arguments(function, from);
    formula.place = since(from);
    return formula;
  }

  Formula comparison() {
    static_cast<void>(rest());
    const std::size_t from = at_;
    Formula formula;
    formula.numbers.push_back(sum());
    const std::optional<Formula::Kind> kind = comparison_sign();
    if (!kind && rest().empty())
      fail(since(from), "a number alone is neither true nor false", "compare it: ... > 0.2 m");
    if (!kind) unexpected();
    formula.kind = kind.value_or(Formula::Kind::less);
    formula.numbers.push_back(sum());
    formula.place = since(from);
    require_one_unit(formula.numbers[0], formula.numbers[1], "compared with");
    if (comparison_sign()) fail({at_ - 1, 1}, "one comparison at a time", "write a < b and b < c");
    return formula;
  }
  std::optional<Formula::Kind> comparison_sign() {
    if (take("<=")) return Formula::Kind::less_or_equal;
    if (take("<")) return Formula::Kind::less;
    if (take(">=")) return Formula::Kind::greater_or_equal;
    if (take(">")) return Formula::Kind::greater;
    return std::nullopt;
  }

  // ------------------------------------------------------------------------------------------ numbers

  /// The mistake is at the right side.
  void require_one_unit(const Number& left, const Number& right, const std::string& how) {
    if (!units_ || mistake_ || fits(left.dimension, right.dimension)) return;
    fail(right.place, name_of(left.dimension) + " cannot be " + how + " " + name_of(right.dimension),
         left.dimension.known == Dimension::Known::by_unit &&
                 left.dimension != Dimension{Dimension::Known::by_unit}
             ? "write a number in " + name_of(left.dimension) + ", or without a unit"
             : "leave the unit out");
  }

  Number combined(Number::Kind kind, std::size_t from, Number left, Number right) {
    Number number;
    number.kind = kind;
    switch (kind) {
      case Number::Kind::product:
        number.dimension = of_product(left.dimension, right.dimension, 1);
        break;
      case Number::Kind::quotient:
        number.dimension = of_product(left.dimension, right.dimension, -1);
        break;
      default:
        require_one_unit(left, right, kind == Number::Kind::sum ? "added to" : "diminished by");
        number.dimension = of_sum(left.dimension, right.dimension);
    }
    number.parts.push_back(std::move(left));
    number.parts.push_back(std::move(right));
    number.place = since(from);
    return number;
  }
  Number sum() {
    static_cast<void>(rest());
    const std::size_t from = at_;
    Number all = product();
    for (;;) {
      if (take("+"))
        all = combined(Number::Kind::sum, from, std::move(all), product());
      else if (take("-"))
        all = combined(Number::Kind::difference, from, std::move(all), product());
      else
        return all;
    }
  }
  Number product() {
    static_cast<void>(rest());
    const std::size_t from = at_;
    Number all = factor();
    for (;;) {
      if (take("*"))
        all = combined(Number::Kind::product, from, std::move(all), factor());
      else if (take("/"))
        all = combined(Number::Kind::quotient, from, std::move(all), divisor());
      else
        return all;
    }
  }

  /// A division by zero must not make a check hold or fail.
  Number divisor() {
    Number number = factor();
    if (number.kind != Number::Kind::literal || number.value == 0)
      fail(number.place, "a number other than 0 must stand here", "compare the product: a < 2 * b");
    return number;
  }

  Number factor() {
    const Level level(*this);
    const std::string_view left = rest();
    const std::size_t from = at_;
    if (take("-")) {
      Number number;
      number.kind = Number::Kind::negative;
      number.parts.push_back(factor());
      number.dimension = number.parts.back().dimension;
      number.place = since(from);
      return number;
    }
    if (take("(")) {
      Number number = sum();
      if (!take(")")) unexpected();
      return number;
    }
    if (!left.empty() && (is_digit(left.front()) || left.front() == '.')) return literal();
    for (const NumberFunction& function : number_functions)
      if (take_word(function.name)) return measured(function, from);
    unknown_function();
    return {};
  }

  void unknown_function() {
    const std::string name(word());
    if (name.empty() || name == "and" || name == "or" || name == "not") return unexpected();
    const Place place{at_, name.size()};
    std::vector<std::string> known;
    for (const Function& function : number_functions) known.emplace_back(function.name);
    for (const Function& function : formula_functions) known.emplace_back(function.name);
    const Hint meant = did_you_mean(name, known);
    fail(place, "'" + name + "' is neither a number nor a function",
         meant.empty() ? "the functions are " + std::string(functions) : meant);
  }

  Number measured(const NumberFunction& function, std::size_t from) {
    Number number;
    number.kind = function.kind;
    number.dimension = function.unit.empty() ? Dimension{.known = Dimension::Known::never}
                                             : dimension_of_unit(function.unit);
    number.elements = arguments(function, from, number.kind == Number::Kind::sensor ? &number : nullptr);
    number.place = since(from);
    return number;
  }

  Number literal() {
    const std::string_view left = rest();
    Number number;
    const std::size_t from = at_;
    const auto [end, error] = std::from_chars(left.data(), left.data() + left.size(), number.value);
    if (error != std::errc() || !std::isfinite(number.value)) {
      fail({at_, 1}, "this is no number", "for example 0.2 or 1e-3");
      return number;
    }
    at_ += static_cast<std::size_t>(end - left.data());
    if (const std::optional<Unit> written = unit()) {
      number.value = converted(number.value, written->factor);
      number.dimension = dimension_of_unit(written->in_si);
    }
    number.place = since(from);
    return number;
  }

  /// Divides where the factor is one over a whole number: 35 cm are 35 / 100 = 0.35 m, and not 35 * 0.01 =
  /// 0.35000000000000003 m.
  [[nodiscard]] static double converted(double number, double factor) {
    const double parts = std::round(1 / factor);
    return parts > 1 && parts * factor == 1 ? number / parts : number * factor;
  }

  /// m, rad, or m/s; nullopt: none. A slash before anything but a letter divides.
  std::optional<Unit> unit() {
    const std::string_view left = rest();
    if (left.empty() || !(is_letter(left.front()) || left.front() == '%')) return std::nullopt;
    std::size_t length = 1;
    while (length < left.size() &&
           (is_letter(left[length]) ||
            (left[length] == '/' && length + 1 < left.size() && is_letter(left[length + 1]))))
      ++length;
    const std::string_view unit = left.substr(0, length);
    if (unit == "and" || unit == "or") return std::nullopt;
    std::optional<Unit> known = units_ ? units_(unit) : std::nullopt;
    if (known)
      at_ += length;
    else
      fail({at_, length}, "unknown unit '" + std::string(unit) + "'",
           "write mm, cm, m, deg, rad, ms, s, min or m/s");
    return known;
  }

  // ------------------------------------------------------------------------------------------ elements

  /// sensor: gets the component that may follow its element.
  std::vector<Element> arguments(const Function& function, std::size_t from, Number* sensor = nullptr) {
    const std::string name(function.name);
    if (!take("(")) fail({from, name.size()}, "'" + name + "' needs brackets", name + "(...)");
    std::vector<Element> all;
    do {
      if (sensor != nullptr && !all.empty()) {
        sensor->component = component();
        sensor->has_component = true;
        break;
      }
      if (all.size() == function.most) {
        too_many(function);
        break;
      }
      all.push_back(element());
    } while (take(","));
    if (all.size() < function.least && rest().starts_with(')'))
      fail(since(from), "'" + name + "' needs " + std::to_string(function.least) + " elements", element_hint);
    if (!take(")")) unexpected();
    return all;
  }
  void too_many(const Function& function) {
    fail({at_ - 1, 1},
         "'" + std::string(function.name) + "' takes at most " + std::to_string(function.most) + " elements",
         element_hint);
  }
  std::size_t component() {
    const std::string_view digits = word();
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (digits.empty() || error != std::errc() || end != digits.data() + digits.size())
      fail({at_, digits.size()}, "the number of a component must follow", "for example sensor(arm/force, 2)");
    else
      at_ += digits.size();
    return number;
  }

  const Units& units_;
  std::uint32_t depth_ = 0;
};

}  // namespace

Parsed<Formula> parse_formula(std::string_view text, const Units& units) {
  return Parser(text, units).whole_formula();
}

Parsed<Number> parse_number(std::string_view text, const Units& units) {
  return Parser(text, units).whole_number();
}

}  // namespace tessera::checks
