#pragma once

#include <string>
#include <vector>

#include "net/net.hpp"
#include "verify/verify.hpp"

/// Shows violations to people: what is wrong, the run that shows it, and which subsystems
/// wait for which at its end.
namespace tessera::project {

/// The net whose transitions the trace of a result names, made from the judged net.
[[nodiscard]] net::Net net_of_run(const net::Net& judged, const verify::PropertyResult& property);

/// The names of the places that hold a token after a run. Empty: it is no run of the net.
[[nodiscard]] std::vector<std::string> marked_after(const net::Net& net,
                                                    const std::vector<net::TransitionId>& run,
                                                    bool only_channels);

/// Name, verdict, method and why in one line.
[[nodiscard]] std::string headline(const verify::PropertyResult& property);

/// The run, step by step, and the channels at its end. A net of the five layers is described subsystem by
/// subsystem. Only the last part of a long run is shown.
[[nodiscard]] std::string run_text(const net::Net& judged, const verify::PropertyResult& property);

/// The headline, the waiting subsystems, and the run if there is one.
[[nodiscard]] std::string text_of(const net::Net& judged, const verify::PropertyResult& property);

}  // namespace tessera::project
