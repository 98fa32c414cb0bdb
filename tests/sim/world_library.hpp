#pragma once

#include <memory>
#include <string>

#include "tessera/device.hpp"

/// The world from its shared library, as in generated controllers. nullptr and `error`: it does not open.
std::unique_ptr<tessera::World> open_world(const tessera::WorldOptions& options, std::string& error);

/// Files the tests share.
std::string line_world();
std::string shipped_track(const std::string& name);
