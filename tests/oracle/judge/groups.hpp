// Behaviours within behaviours: what a group adds to the conditions and to `next` of what stands in it.
#pragma once

#include <string>

#include "oracle/specification/specification.hpp"

namespace oracle {

/// A behaviour with all conditions that may end it, and all entries that may follow. `end` in it is the output place of
/// the page in which it stands. The conditions of a group are the ways in which it is left.
Behaviour written_out(const Subsystem& subsystem, const Behaviour& behaviour);

/// "g0.g1.b3"
std::string path_in(const Subsystem& subsystem, const Behaviour& behaviour);
/// The behaviour or group with which a subsystem begins, or a group: the one that stands in it.
const Behaviour& first_in(const Subsystem& subsystem, const std::string& group);
const Behaviour& behaviour_named(const Subsystem& subsystem, const std::string& name);

}  // namespace oracle
