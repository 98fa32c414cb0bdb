#pragma once

#include "spec/model/model.hpp"

namespace tessera::cli {

/// Prints the panels that cannot be operated in a simulated run without a control socket.
void tell_of_panels(const spec::Model& model);

}  // namespace tessera::cli
