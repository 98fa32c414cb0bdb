#pragma once

#include "spec/model/model.hpp"

namespace tessera::cli {

/// Says which panels nobody can operate in a simulated run that takes no commands.
void tell_of_panels(const spec::Model& model);

}  // namespace tessera::cli
