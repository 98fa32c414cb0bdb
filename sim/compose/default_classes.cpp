#include "sim/compose/default_classes.hpp"

#include <vector>

#include "sim/mjcf/xml.hpp"

namespace tessera::sim {

std::string main_class_of(pugi::xml_node root) {
  std::string name = "main";
  for (const pugi::xml_node section : root.children("default")) {
    name = section.attribute("class").value();
    if (name.empty()) name = "main";
  }
  return name;
}

void copy_default_classes(pugi::xml_node root, const Naming& naming, pugi::xml_node defaults) {
  std::vector<pugi::xml_node> sections;
  for (const pugi::xml_node section : root.children("default")) sections.push_back(section);
  pugi::xml_node parent = defaults;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const pugi::xml_node copy = parent.append_copy(sections[i]);
    naming.rename(copy);
    const bool is_last = i + 1 == sections.size();
    set_attribute(copy, "class",
                  naming.main_class() + (is_last ? "" : " of section " + std::to_string(i + 1)));
    parent = copy;
  }
  if (sections.empty()) set_attribute(parent.append_child("default"), "class", naming.main_class());
}

}  // namespace tessera::sim
