// How long a call may take on a processor that several subsystems share.
#pragma once

#include <vector>

#include "timing/patience.hpp"
#include "timing/system.hpp"

namespace tessera::timing {

struct Response {
  Time call = unbounded;      ///< most time of a call, from the moment that it can begin
  Time dispatch = unbounded;  ///< most time that it waits for the processor when it could go on
};

/// The response of each subsystem, under fixed priorities.
/// Source: Joseph & Pandya, Computer Journal 29(5), 1986. Among equals, the busy period of their level.
[[nodiscard]] std::vector<Response> responses_of(const System& system, const StopAsked& stop = {});

}  // namespace tessera::timing
