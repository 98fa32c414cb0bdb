// The rules of the operators: which operands go together.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/conditions/operators.hpp"

namespace tessera::spec {

namespace {

using diagnostics::in_quotes;
using Is = Value::Kind;

/// For a number where a duration belongs. It may have letters that are no unit: "500msec".
std::string unit_hint(const std::string& number) {
  if (number.find_first_not_of("0123456789.'") == std::string::npos)
    return fmt::format("write the unit: {0} s or {0} ms", number);
  return "durations are written like 500 ms; the units are h, min, s, ms, us and ns";
}

/// Whether C++ takes a negative value of the signed type for a large one of the unsigned type.
bool loses_sign(Scalar is_signed, Scalar is_unsigned) {
  const bool any = is_signed == Scalar::int8 || is_signed == Scalar::int16 || is_signed == Scalar::int32;
  if (is_unsigned == Scalar::uint32) return any;
  return is_unsigned == Scalar::uint64 && (any || is_signed == Scalar::int64);
}

/// The number that a literal such as "3" or "0.5" is; nullopt: it has another form.
std::optional<double> decimal(std::string_view text) {
  const bool octal = text.size() > 1 && text.front() == '0' && text[1] != '.';
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end && !octal ? std::optional(number) : std::nullopt;
}

/// "cmp_less" for "<".
std::string_view function_for(const Token& mark) {
  if (mark.is("==")) return "cmp_equal";
  if (mark.is("<")) return "cmp_less";
  if (mark.is(">")) return "cmp_greater";
  if (mark.is("<=")) return "cmp_less_equal";
  return mark.is(">=") ? "cmp_greater_equal" : "cmp_not_equal";
}

}  // namespace

Value ConditionOperators::combine(const Token& mark, const Value& left, const Value& right) {
  if (mark.is_one_of({"&&", "||", "and", "or"})) return combine_logical(mark, left, right);
  if (mark.is_one_of({"==", "!=", "not_eq", "<", ">", "<=", ">="})) return compare(mark, left, right);
  if (mark.is_one_of({"+", "-"})) return add(mark, left, right);
  if (mark.is_one_of({"*", "/"})) return multiply(mark, left, right);
  if (mark.is_one_of({"&", "|", "^", "bitand", "bitor", "xor"})) check_bits(mark, left, right);
  return {};
}

/// C++ reads "a & b == c" as "a & (b == c)".
void ConditionOperators::check_bits(const Token& mark, const Value& left, const Value& right) {
  const bool mixed =
      (left.comparison && right.kind == Is::number) || (right.comparison && left.kind == Is::number);
  if (mixed)
    mistake_at(mark, "E212", "the comparison is made before " + in_quotes(mark.text),
               fmt::format("write brackets: (a {} b) == c", mark.text));
}

Value ConditionOperators::combine_logical(const Token& mark, const Value& left, const Value& right) {
  need_truth(left, in_quotes(mark.text));
  need_truth(right, in_quotes(mark.text));
  Value both;
  both.kind = Is::boolean;
  return both;
}

void ConditionOperators::need_truth(const Value& value, const std::string& where) {
  if (value.kind == Is::unknown || value.kind == Is::boolean) return;
  if (value.kind == Is::number) {
    // Counts and flags of integers are usual conditions in C++; a measured value that is exactly 0 is not.
    const bool is_measure =
        value.declared && (!value.type.unit.empty() || value.type.scalar == Scalar::float32 ||
                           value.type.scalar == Scalar::float64);
    if (!is_measure) return;
    warn_of_truth(value, where + " needs true or false; " + described(value),
                  "every number but 0 is true; compare it: " + text_of(value) + " > 0");
    return;
  }
  if (value.kind == Is::choice) return compare_choice({}, value, {});
  std::string hint;
  if (value.kind == Is::duration) hint = "compare it: " + text_of(value) + " > 500 ms";
  if (value.kind == Is::structure && value.declared) {
    const std::vector<Field>& fields = scope_.types.fields_of(value.type);
    if (!fields.empty()) hint = "choose a field: " + text_of(value) + "." + fields.front().name;
  }
  if (value.kind == Is::array) hint = "choose an element: " + text_of(value) + "[0]";
  mistake("E212", value, where + " needs true or false; " + described(value), hint);
}

Value ConditionOperators::compare(const Token& mark, const Value& left, const Value& right) {
  Value result;
  result.kind = Is::boolean;
  result.comparison = true;
  if (left.comparison && !mark.is_one_of({"==", "!=", "not_eq"})) {
    mistake_at(mark, "E212", "a comparison of a comparison compares true or false",
               "write two comparisons: a < b && b < c");
    return result;
  }
  hint_at_minutes(left, right);
  if (left.kind == Is::choice || right.kind == Is::choice) {
    const Value& other = left.kind == Is::choice ? right : left;
    if (const std::string text = text_of(other); other.kind == Is::unknown && text.starts_with('"'))
      mistake("E263", other, text + " is text, and values have names",
              fmt::format("write it without quotes: {}", text.substr(1, text.find('"', 1) - 1)));
    if (left.kind != Is::unknown && right.kind != Is::unknown) compare_choice(mark, left, right);
    return result;
  }
  check_count(mark, left, right);
  for (const auto& [one, other] : {std::pair{left, right}, std::pair{right, left}}) {
    if (one.kind == Is::unknown || other.kind == Is::unknown) return result;
    if (one.kind == other.kind) continue;
    if (one.kind == Is::duration && other.is_plain()) {
      if (other.time_unit.empty())
        mistake("E212", other, described(one) + ", " + described(other), hint_for_duration(one, other));
      else
        as_duration(other);
      return result;
    }
    if (one.kind == Is::time) {
      mistake("E212", other, described(one) + ", " + described(other),
              "an input has its age too: in.NAME.age > 500 ms");
      return result;
    }
    const bool is_null = other.literal && text_of(other) == "0";
    if (one.is_compound() && (other.is_plain() || other.kind == Is::duration) &&
        !(one.kind == Is::text && is_null)) {
      std::string hint;
      if (one.kind == Is::structure && one.declared) {
        const std::vector<Field>& fields = scope_.types.fields_of(one.type);
        if (!fields.empty()) hint = "choose a field: " + text_of(one) + "." + fields.front().name;
      }
      if (one.kind == Is::array) hint = "choose an element: " + text_of(one) + "[0]";
      if (one.kind == Is::text) hint = "compare it with text in quotes: " + text_of(one) + R"( == "...")";
      mistake("E212", one, described(one) + ", " + described(other), hint);
      return result;
    }
  }
  const bool mixed = left.kind != right.kind && left.is_plain() && right.is_plain();
  const Value& number = left.kind == Is::number ? left : right;
  if (mixed && !(number.literal && (text_of(number) == "0" || text_of(number) == "1"))) {
    const Value& truth = left.kind == Is::number ? right : left;
    warn_of_truth(number, described(truth) + ", " + described(number), "true is 1 there, and false is 0");
  }
  if (check_signs(mark, left, right)) check_units(mark, left, right);
  return result;
}

/// A number in a unit of time is a duration beside one.
void ConditionOperators::as_duration(const Value& number) {
  times_.push_back({number.begin, number.end, number.time_unit});
}

std::vector<Expression::TimeNumber> ConditionOperators::times() const {
  std::vector<Expression::TimeNumber> sorted = times_;
  std::ranges::sort(sorted, {}, &Expression::TimeNumber::begin);
  return sorted;
}

/// For a number that measures no time, beside a duration.
std::string ConditionOperators::hint_for_duration(const Value& duration, const Value& number) const {
  if (number.literal) return unit_hint(text_of(number));
  if (number.kind == Is::number && number.declared && number.few == nullptr) {
    const std::string& unit = number.type.unit;
    if (unit.empty()) return "declare " + text_of(number) + " with a unit of time: h, min, s, ms, us or ns";
    if (duration.literal) return fmt::format("{} is in {}: write the number alone", text_of(number), unit);
    return fmt::format("{} is in {}, which is no unit of time; compare it with a duration such as 500 ms",
                       text_of(number), unit);
  }
  return "compare it with a duration such as 500 ms";
}

/// A memory cell with values is equal to one of its values, or not. mark: none if it is not compared.
void ConditionOperators::compare_choice(const Token& mark, const Value& left, const Value& right) {
  const Value& cell = left.kind == Is::choice && !left.literal ? left : right;
  const bool fits = left.few == right.few && left.literal != right.literal;
  if (fits && mark.is_one_of({"==", "!=", "not_eq"})) return;
  const Value& at = cell.few == nullptr ? left : cell;
  mistake("E263", at, described(at),
          fmt::format("compare it with one of its values: memory.{} == {}", at.few->name,
                      at.few->few->names.front()));
}

/// A comparison that no count fits is a mistake of the author.
void ConditionOperators::check_count(const Token& mark, const Value& left, const Value& right) {
  for (const bool is_left : {true, false}) {
    const Value& one = is_left ? left : right;
    const Value& other = is_left ? right : left;
    if (one.few == nullptr || !other.literal) continue;
    const FewValues& few = *one.few->few;
    const std::optional<double> number = decimal(text_of(other));
    if (!number || few.names.empty()) continue;
    const double least = few.least, most = least + static_cast<double>(few.names.size() - 1);
    const bool is_count = *number >= least && *number <= most && *number == std::floor(*number);
    const auto never = [&](const char* what) {
      mistake("E264", other, fmt::format("{} is never {}{}", text_of(one), what, text_of(other)),
              "it is " + few.in_words());
    };
    if (mark.is_one_of({"==", "!=", "not_eq"}) && !is_count) never("");
    if (mark.is(is_left ? "<" : ">") && least >= *number) never("less than ");
    if (mark.is(is_left ? "<=" : ">=") && least > *number) never("at most ");
    if (mark.is(is_left ? ">" : "<") && most <= *number) never("more than ");
    if (mark.is(is_left ? ">=" : "<=") && most < *number) never("at least ");
  }
}

/// Refuses what the build would refuse. false: it has. The type of a sum or a product is not known exactly.
bool ConditionOperators::check_signs(const Token& mark, const Value& left, const Value& right) {
  for (const Value* one : {&left, &right})
    if (one->kind != Is::number || !one->declared ||
        text_of(*one).find_first_of("+-*/ ") != std::string::npos)
      return true;
  if (!loses_sign(left.type.scalar, right.type.scalar) && !loses_sign(right.type.scalar, left.type.scalar))
    return true;
  mistake_at(mark, "E212",
             fmt::format("{} and {}: only one of them can be negative", described(left), described(right)),
             fmt::format("write std::{}({}, {})", function_for(mark), text_of(left), text_of(right)));
  return false;
}

/// Corrects the message about "2 m" beside a duration, which was reported as no number: it means minutes.
void ConditionOperators::hint_at_minutes(const Value& left, const Value& right) {
  for (const auto& [one, other] : {std::pair{left, right}, std::pair{right, left}}) {
    const std::string text = text_of(other);
    if (one.kind != Is::duration || !other.literal || other.kind != Is::unknown || !text.ends_with('m'))
      continue;
    mistakes_.back().message = described(one) + ", " + in_quotes(text) + " is a length";
    mistakes_.back().hint = fmt::format("write {} min", text.substr(0, text.find_last_not_of(" m") + 1));
  }
}

/// Warns of a number where true or false is meant. C++ allows both.
void ConditionOperators::warn_of_truth(const Value& value, std::string message, std::string hint) {
  mistakes_.push_back({true, "W326", positions_.part(value.begin, value.end - value.begin),
                       std::move(message), std::move(hint)});
}

/// Warns of m and mm; false: it has.
bool ConditionOperators::check_units(const Token& mark, const Value& left, const Value& right) {
  const bool known = left.kind == Is::number && right.kind == Is::number && left.declared && right.declared &&
                     !left.type.unit.empty() && !right.type.unit.empty();
  if (!known || left.type.unit == right.type.unit) return true;
  mistakes_.push_back({true, "W325", positions_.part(mark.position, mark.text.size()),
                       fmt::format("{} is in {}, {} is in {}", in_quotes(text_of(left)), left.type.unit,
                                   in_quotes(text_of(right)), right.type.unit),
                       "units are compared as they are written; numbers are not converted"});
  return false;
}

Value ConditionOperators::add(const Token& mark, const Value& left, const Value& right) {
  if (left.kind == Is::unknown || right.kind == Is::unknown) return {};
  Value result;
  if (left.is_compound() || right.is_compound()) {
    if (left.kind != Is::text && right.kind != Is::text)
      mistake("E212", left.is_compound() ? left : right,
              in_quotes(mark.text) + " needs numbers; " + described(left.is_compound() ? left : right));
    return result;
  }
  const bool durations = left.kind == Is::duration || right.kind == Is::duration;
  if (durations && (left.is_plain() || right.is_plain())) {
    const Value& plain = left.is_plain() ? left : right;
    const Value& duration = left.is_plain() ? right : left;
    if (plain.time_unit.empty()) {
      mistake("E212", plain, described(duration) + ", " + described(plain),
              hint_for_duration(duration, plain));
      return result;
    }
    as_duration(plain);
    result.kind = Is::duration;
    return result;
  }
  if (left.kind == Is::time && !right.time_unit.empty()) {
    as_duration(right);
    result.kind = Is::time;
    return result;
  }
  if (left.kind == Is::time && right.kind == Is::time) {
    result.kind = Is::duration;
  } else if (left.kind == Is::time || right.kind == Is::time) {
    result.kind = durations ? Is::time : Is::unknown;
  } else {
    result.kind = durations ? Is::duration : Is::number;
    if (!durations && !check_units(mark, left, right)) return result;
    result.declared = result.kind == Is::number && left.declared && right.declared;
    if (result.declared) result.type = left.type;
    if (left.time_unit == right.time_unit) result.time_unit = left.time_unit;
  }
  return result;
}

Value ConditionOperators::multiply(const Token& mark, const Value& left, const Value& right) {
  Value result;
  if (left.kind == Is::unknown || right.kind == Is::unknown) return result;
  if (left.is_compound() || right.is_compound()) {
    const Value& compound = left.is_compound() ? left : right;
    mistake("E212", compound, in_quotes(mark.text) + " needs numbers; " + described(compound));
    return result;
  }
  if (left.is_plain() && right.is_plain()) {
    result.kind = Is::number;
    const auto is_pure = [](const Value& value) {
      return value.time_unit.empty() && !(value.declared && !value.type.unit.empty());
    };
    if (is_pure(right) && !mark.is("%")) result.time_unit = left.time_unit;
    if (is_pure(left) && mark.is("*")) result.time_unit = right.time_unit;
    return result;
  }
  if (left.kind == Is::duration && mark.is("/") && !right.time_unit.empty()) {
    as_duration(right);
    result.kind = Is::number;
    return result;
  }
  if (left.kind == Is::duration && right.is_plain()) result.kind = Is::duration;
  if (left.kind == Is::duration && right.kind == Is::duration && mark.is("/")) result.kind = Is::number;
  if (left.is_plain() && right.kind == Is::duration && mark.is("*")) result.kind = Is::duration;
  return result;
}

void ConditionOperators::mistake(std::string code, const Value& value, std::string message,
                                 std::string hint) {
  mistakes_.push_back({false, std::move(code),
                       positions_.part(value.begin, std::max(value.end, value.begin + 1) - value.begin),
                       std::move(message), std::move(hint)});
}

void ConditionOperators::mistake_at(const Token& mark, std::string code, std::string message,
                                    std::string hint) {
  mistakes_.push_back({false, std::move(code), positions_.part(mark.position, mark.text.size()),
                       std::move(message), std::move(hint)});
}

std::string ConditionOperators::text_of(const Value& value) const {
  return std::string(text_.substr(value.begin, value.end - value.begin));
}

std::string ConditionOperators::described(const Value& value) const {
  return in_quotes(text_of(value)) + " is " + in_words(value, scope_.types);
}

}  // namespace tessera::spec
