#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "checks/dimension.hpp"

/// Formulas and numbers about a simulated world, as the checks and measures of a specification write them:
///
///     formula     = conjunction { "or" conjunction }       conjunction = negation { "and" negation }
///     negation    = "not" negation | "(" formula ")" | ("any" | "all") "(" formula ")"
///                 | "contact" "(" element [ "," element ] ")" | "inside" "(" element "," element ")"
///                 | number ("<" | "<=" | ">" | ">=") number
///     number      = product { ("+" | "-") product }        product = factor { ("*" | "/") factor }
///     factor      = "-" factor | DIGITS [ UNIT ] | "(" number ")" | "distance" "(" element "," element ")"
///                 | ("height" | "speed" | "laps" | "line_error" | "line_lost") "(" element ")"
///                 | "sensor" "(" element [ "," DIGITS ] ")"
///     element     = NAME [ "[" index "]" ] { "/" NAME }    index = DIGITS | "*" | "i" [ ("+" | "-") DIGITS ]
///
/// `and`, `or`, `not`, `any` and `all` mean what they mean in properties.
namespace tessera::checks {

/// Bytes of the text.
struct Place {
  std::size_t offset = 0, length = 0;
};

/// Something in the world: "rover", "arm/touch", "robot[3]/gripper", "box[*]", "robot[i+1]".
struct Element {
  std::string name;  ///< before the index; all of it if there is none
  enum class Index : std::uint8_t {
    none,
    constant,  ///< robot[3]
    every,     ///< robot[*]
    running    ///< robot[i+1]
  } index = Index::none;
  std::int64_t number = 0;  ///< constant: the index; running: what is added to i
  std::string rest;         ///< after the index, with the slash
  Place place;
};

struct Number {
  enum class Kind : std::uint8_t {
    literal,
    distance,    ///< of two origins, in m
    height,      ///< of an origin over the world's, in m
    speed,       ///< of an origin, in m/s
    sensor,      ///< one of the numbers that a sensor gives
    laps,        ///< of a robot on the line of a track
    line_error,  ///< of its middle light sensor, in m
    line_lost,   ///< for how long no light sensor of it has been over the line, in s
    sum,
    difference,
    product,
    quotient,
    negative
  } kind = Kind::literal;
  double value = 0;  ///< of a literal, in SI units
  std::vector<Element> elements;
  std::size_t component = 0;  ///< of a sensor
  bool has_component = false;
  Dimension dimension;
  std::vector<Number> parts;
  Place place;
};

struct Formula {
  enum class Kind : std::uint8_t {
    less,
    less_or_equal,
    greater,
    greater_or_equal,
    contact,  ///< of two elements, or of one with anything else
    inside,   ///< the origin of the first is within the second, a site
    negation,
    both,
    either,
    every,  ///< the only part holds for all that [*] stands for
    some    ///< the only part holds for at least one that [*] stands for
  } kind = Kind::less;
  std::vector<Number> numbers;  ///< the two sides of a comparison
  std::vector<Element> elements;
  std::vector<Formula> parts;
  Place place;
};

/// As it may be written, with numbers in SI units and without units.
[[nodiscard]] std::string text_of(const Element& element);
[[nodiscard]] std::string text_of(const Number& number);
[[nodiscard]] std::string text_of(const Formula& formula);

}  // namespace tessera::checks
