#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

/// MJCF elements and numbers in their attributes. Numbers keep every bit.
namespace tessera::sim {

/// Sets the attribute, which may be new.
void set_attribute(pugi::xml_node element, const char* name, std::string_view value);

[[nodiscard]] std::string numbers_text(const double* values, std::size_t count);
[[nodiscard]] std::string numbers_text(const float* values, std::size_t count);
[[nodiscard]] std::string numbers_text(const int* values, std::size_t count);
[[nodiscard]] inline std::string numbers_text(const std::vector<double>& values) {
  return numbers_text(values.data(), values.size());
}
/// The numbers of a text up to the first that is none.
[[nodiscard]] std::vector<double> numbers_in(std::string_view text);

[[nodiscard]] inline bool is_element(pugi::xml_node node) { return node.type() == pugi::node_element; }
/// Whether it is a joint, geom or site of a body, not a reference to one in a tendon.
[[nodiscard]] bool stands_in_body(pugi::xml_node element);

/// Calls `visit` for the element and all elements below it, parents first. `visit` may change attributes.
template <class Visit>
void for_each_element(pugi::xml_node element, const Visit& visit) {
  if (!is_element(element)) return;
  visit(element);
  for (const pugi::xml_node child : element.children()) for_each_element(child, visit);
}

}  // namespace tessera::sim
