#pragma once

#include <pugixml.hpp>
#include <string>

#include "sim/compose/naming.hpp"

namespace tessera::sim {

/// The name of a file's outermost default class: usually "main".
[[nodiscard]] std::string main_class_of(pugi::xml_node root);

/// Copies the default classes of a file below `defaults` and renames them.
///
/// A file may have several outermost sections, for instance from included files. A class inherits from the
/// sections up to its own, so each further section becomes a child of the one before.
void copy_default_classes(pugi::xml_node root, const Naming& naming, pugi::xml_node defaults);

}  // namespace tessera::sim
