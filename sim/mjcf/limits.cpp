#include "sim/mjcf/limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "sim/mjcf/xml.hpp"

namespace tessera::sim {
namespace {

struct Limit {
  std::string_view element, attribute;
  double most;  ///< for the product of the numbers
};

constexpr std::array<Limit, 22> limits{{
    {"composite", "count", 10'000},    {"skin", "subgrid", 50},          {"texture", "width", 4'096},
    {"texture", "height", 25'000},     {"texture", "gridsize", 10'000},  {"hfield", "nrow", 5'000},
    {"hfield", "ncol", 5'000},         {"numeric", "size", 1'000'000},   {"user", "dim", 100'000},
    {"size", "njmax", 10'000},         {"size", "nconmax", 100'000},     {"size", "nstack", 1e9},
    {"size", "nuserdata", 10'000'000}, {"size", "nkey", 10'000},         {"size", "nuser_body", 10'000},
    {"size", "nuser_jnt", 10'000},     {"size", "nuser_geom", 10'000},   {"size", "nuser_site", 10'000},
    {"size", "nuser_cam", 10'000},     {"size", "nuser_tendon", 10'000}, {"size", "nuser_actuator", 10'000},
    {"size", "nuser_sensor", 10'000},
}};

/// Empty: the numbers are within the limit. -1 means "as many as needed".
std::string_view trouble(std::string_view text, double most) {
  double product = 1;
  for (const double value : numbers_in(text)) {
    if (value < -1) return "is negative";
    if (!(value <= most)) return "is too large";
    product *= std::max(1.0, value);
  }
  return product > most ? "is too large" : "";
}

/// Attributes that may hold any text.
constexpr auto texts = std::to_array<std::string_view>(
    {"name", "class", "childclass", "model", "file", "prefix", "data", "objname", "refname"});

/// The engine may compute without end with a value that is not a number, or that is too large.
bool is_beyond_measure(pugi::xml_attribute attribute) {
  if (std::ranges::find(texts, std::string_view(attribute.name())) != texts.end()) return false;
  // With negative damping, the engine may search the length range of a muscle without end.
  const double least = std::string_view(attribute.name()) == "damping" ? 0 : -1e30;
  return std::ranges::any_of(numbers_in(attribute.value()),
                             [&](double value) { return !(value >= least && value <= 1e30); });
}

Problem about(pugi::xml_node element, std::string_view attribute, std::string_view what) {
  const std::string value = element.attribute(std::string(attribute).c_str()).value();
  return Problem{"`" + std::string(attribute) + "` of `" + element.name() + "` " + std::string(what) + ": " +
                 value.substr(0, 60)};
}

}  // namespace

std::optional<Problem> unusable_number(pugi::xml_node root) {
  std::optional<Problem> problem;
  for_each_element(root, [&](pugi::xml_node element) {
    if (problem) return;
    for (const pugi::xml_attribute attribute : element.attributes()) {
      if (is_beyond_measure(attribute)) problem = about(element, attribute.name(), "is no usable number");
    }
    for (const Limit& limit : limits) {
      if (limit.element != element.name()) continue;
      const std::string name(limit.attribute);
      const std::string_view what = trouble(element.attribute(name.c_str()).value(), limit.most);
      if (!what.empty()) problem = about(element, name, what);
    }
  });
  return problem;
}

}  // namespace tessera::sim
