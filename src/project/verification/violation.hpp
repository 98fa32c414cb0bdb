#pragma once

#include <string>
#include <vector>

#include "net/net.hpp"
#include "verify/verify.hpp"

/// Violations for people: what is wrong, the run that shows it, and who waits for whom at its end.
namespace tessera::project {

/// The net whose transitions a result's trace names, of the net that was judged.
[[nodiscard]] net::Net net_of_run(const net::Net& judged, const verify::PropertyResult& property);

/// The places that a run leaves with a token, by name. Empty: it is no run of the net.
[[nodiscard]] std::vector<std::string> marked_after(const net::Net& net,
                                                    const std::vector<net::TransitionId>& run,
                                                    bool only_channels);

/// Name, verdict, method and why in one line.
[[nodiscard]] std::string headline(const verify::PropertyResult& property);

/// The run, step by step, and the channels at its end. A net of the five layers is told subsystem by
/// subsystem; of a long run, the last part.
[[nodiscard]] std::string run_text(const net::Net& judged, const verify::PropertyResult& property);

/// headline, who waits for whom, and the run if there is one.
[[nodiscard]] std::string text_of(const net::Net& judged, const verify::PropertyResult& property);

}  // namespace tessera::project
