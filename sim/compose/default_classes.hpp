#pragma once

#include <pugixml.hpp>
#include <string>

#include "sim/compose/naming.hpp"

namespace tessera::sim {

/// What a file calls its outermost default class: "main", as a rule.
[[nodiscard]] std::string main_class_of(pugi::xml_node root);

/// Copies the default classes of a file below `defaults` and renames them.
///
/// A file may have several outermost sections, for instance from files that it includes. A class takes over
/// what stands in the sections up to its own, so that each further section becomes a child of the one before.
void copy_default_classes(pugi::xml_node root, const Naming& naming, pugi::xml_node defaults);

}  // namespace tessera::sim
