#pragma once

#include "spec/model/model.hpp"

namespace tessera::spec {

/// Judges whether each sink of the real robot has one writer, as far as the specification tells. The elements
/// of a simulated world are judged by the world (src/project/files/world_check.hpp).
///
/// Errors:   E319 a service of ROS 2 with two servers.
/// Warnings: W338 a topic that two effectors publish; W339 two effectors with one port of a C++ class.
void check_writers(const Model& model, Diagnostics& out);

}  // namespace tessera::spec
