// A smaller specification that shows the same disagreement.
#pragma once

#include <functional>

#include "specification.hpp"

namespace oracle {

/// Leaves out and simplifies, one thing after the other, while `still_shows` says so. Calls it at most
/// `tries` times.
Specification shrink(Specification specification,
                     const std::function<bool(const Specification&)>& still_shows, int tries);

}  // namespace oracle
