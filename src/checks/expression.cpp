#include "checks/expression.hpp"

#include <fmt/format.h>

#include <string_view>

namespace tessera::checks {
namespace {

std::string call(std::string_view function, const std::vector<Element>& elements) {
  std::string text(function);
  for (const Element& element : elements)
    text += (&element == &elements.front() ? "(" : ", ") + text_of(element);
  return text + ")";
}

std::string sensor_text(const Number& number) {
  std::string text = call("sensor", number.elements);
  if (!number.has_component) return text;
  text.pop_back();
  return fmt::format("{}, {})", text, number.component);
}

/// The parts with brackets, so that no rule of precedence is needed.
std::string joined(const Number& number, std::string_view by) {
  return fmt::format("({} {} {})", text_of(number.parts.at(0)), by, text_of(number.parts.at(1)));
}

std::string joined(const Formula& formula, std::string_view by) {
  std::string text;
  for (const Formula& part : formula.parts)
    text += text.empty() ? text_of(part) : fmt::format(" {} {}", by, text_of(part));
  return "(" + text + ")";
}

std::string compared(const Formula& formula, std::string_view by) {
  return fmt::format("{} {} {}", text_of(formula.numbers.at(0)), by, text_of(formula.numbers.at(1)));
}

}  // namespace

std::string text_of(const Element& element) {
  switch (element.index) {
    case Element::Index::none:
      return element.name + element.rest;
    case Element::Index::constant:
      return fmt::format("{}[{}]{}", element.name, element.number, element.rest);
    case Element::Index::every:
      return fmt::format("{}[*]{}", element.name, element.rest);
    case Element::Index::running:
      break;
  }
  if (element.number == 0) return fmt::format("{}[i]{}", element.name, element.rest);
  return fmt::format("{}[i{:+}]{}", element.name, element.number, element.rest);
}

std::string text_of(const Number& number) {
  switch (number.kind) {
    case Number::Kind::literal:
      return fmt::format("{}", number.value);
    case Number::Kind::distance:
      return call("distance", number.elements);
    case Number::Kind::height:
      return call("height", number.elements);
    case Number::Kind::speed:
      return call("speed", number.elements);
    case Number::Kind::sensor:
      return sensor_text(number);
    case Number::Kind::laps:
      return call("laps", number.elements);
    case Number::Kind::line_error:
      return call("line_error", number.elements);
    case Number::Kind::line_lost:
      return call("line_lost", number.elements);
    case Number::Kind::sum:
      return joined(number, "+");
    case Number::Kind::difference:
      return joined(number, "-");
    case Number::Kind::product:
      return joined(number, "*");
    case Number::Kind::quotient:
      return joined(number, "/");
    case Number::Kind::negative:
      return "-" + text_of(number.parts.at(0));
  }
  return {};
}

std::string text_of(const Formula& formula) {
  switch (formula.kind) {
    case Formula::Kind::less:
      return compared(formula, "<");
    case Formula::Kind::less_or_equal:
      return compared(formula, "<=");
    case Formula::Kind::greater:
      return compared(formula, ">");
    case Formula::Kind::greater_or_equal:
      return compared(formula, ">=");
    case Formula::Kind::contact:
      return call("contact", formula.elements);
    case Formula::Kind::inside:
      return call("inside", formula.elements);
    case Formula::Kind::negation:
      return fmt::format("not ({})", text_of(formula.parts.at(0)));
    case Formula::Kind::both:
      return joined(formula, "and");
    case Formula::Kind::either:
      return joined(formula, "or");
    case Formula::Kind::every:
      return fmt::format("all({})", text_of(formula.parts.at(0)));
    case Formula::Kind::some:
      return fmt::format("any({})", text_of(formula.parts.at(0)));
  }
  return {};
}

}  // namespace tessera::checks
