// A smaller specification that shows the same disagreement.
#pragma once

#include <functional>

#include "specification.hpp"

namespace oracle {

/// Removes and simplifies parts one by one while `still_shows` is true. Calls it at most `tries` times.
Specification shrink(Specification specification,
                     const std::function<bool(const Specification&)>& still_shows, int tries);

}  // namespace oracle
