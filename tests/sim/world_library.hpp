#pragma once

#include <memory>
#include <string>

#include "tessera/device.hpp"

/// The world as generated controllers get it: from its shared library. nullptr and `error` when it does not
/// open.
std::unique_ptr<tessera::World> open_world(const tessera::WorldOptions& options, std::string& error);

/// Files the tests share.
std::string line_world();
std::string shipped_track(const std::string& name);
