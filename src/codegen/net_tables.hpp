#pragma once

#include <string>

#include "codegen/local_net.hpp"
#include "codegen/project.hpp"

namespace tessera::codegen {

/// "" for the first variant of a net, "_2", "_3" for the others.
[[nodiscard]] std::string variant_suffix(std::size_t variant);

/// The behaviours of a unit and, for each variant of its net, ports, places and transitions as constant
/// tables, in columns. They stand in an anonymous namespace.
[[nodiscard]] std::string net_tables(const Project& project, const Unit& unit, const NetVariants& variants);

/// The definitions of net, net_2, ... over those tables.
[[nodiscard]] std::string net_definitions(const NetVariants& variants);

}  // namespace tessera::codegen
