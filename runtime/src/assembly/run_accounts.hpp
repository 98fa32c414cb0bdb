// The resources that the subsystems of a run have used, and the calls that took longer than declared.
#pragma once

#include <vector>

#include "assembly/assembly.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// The amounts that all behaviours have used until now.
[[nodiscard]] std::vector<RunSummary::Used> used_resources(const Assembly& assembly, Time now);

/// The behaviours with calls that took longer than their `takes`.
[[nodiscard]] std::vector<RunSummary::SlowCalls> slow_calls(const Assembly& assembly);

}  // namespace tessera
