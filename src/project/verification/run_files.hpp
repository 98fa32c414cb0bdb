#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "net/net.hpp"
#include "verify/counterexample/narrative.hpp"
#include "verify/verify.hpp"

/// Writes runs that show violations for viewers that step through them, and for `simulate --scenario`. A "line" is one
/// of the specification itself. It is 0, and "included": "parts/docking.yaml:3" stands beside it, for a line of an
/// included file.
namespace tessera::project {

/// {"net", "net_hash", "initial": [place...], "traces": [{"property", "verdict", "method", "why",
/// "exceptions", "firings": [{"transition", "subsystem", "page", "line", "takes": [place...],
/// "gives": [place...]}], "story": [{"first", "last", "who", "text", "line"}], "end": [place...],
/// "channels": [...], "waits": [...]}]}
///
/// pages: of a net of the five layers; nullptr for other nets.
[[nodiscard]] nlohmann::json traces_json(const std::string& file, const net::Net& net,
                                         const net::HierarchicalNet* pages, const verify::Report& report);

/// The firings of one run, as in traces_json.
[[nodiscard]] nlohmann::json firings_json(const net::Net& net, const net::HierarchicalNet* pages,
                                          const std::vector<net::TransitionId>& run);

/// [{"path", "line"}]: the behaviours that a verdict refers to.
[[nodiscard]] nlohmann::json behaviours_json(const verify::PropertyResult& property);

/// [{"path", "state", "awaited", "behaviour", "channel", "from": [path...], "text"}]: what subsystems do at the
/// end of a run (verify::SubsystemAtEnd).
[[nodiscard]] nlohmann::json at_end_json(const std::vector<verify::SubsystemAtEnd>& waits);
/// Throws an exception if it is something else.
[[nodiscard]] std::vector<verify::SubsystemAtEnd> at_end_from(const nlohmann::json& waits);

/// [{"first", "last", "who", "text", "line"}]: the run of a net of the five layers in
/// sentences (verify::narrate).
[[nodiscard]] nlohmann::json story_json(const net::Net& net, const std::vector<net::TransitionId>& run,
                                        verify::Wording wording = verify::Wording::with_transitions);

/// {"properties": [{"name", "asks", "verdict", "method", "why", "meaning", "explanation", "seconds",
/// "states", "warning", "waits", "behaviours": [{"path", "line"}], "trace": firings or null}],
/// "net_hash", "verification_hash"}
[[nodiscard]] nlohmann::json report_json(const net::Net& net, const net::HierarchicalNet* pages,
                                         const verify::Report& report);

/// {"scenario": 1, "net_hash", "property", "why", "firings": [firing...], "waits": [...]}: a run that a
/// controller of that net can follow. A firing is the name of a transition, or {"name", "none_holds":
/// subsystem}: no condition of `next` holds there.
[[nodiscard]] nlohmann::json scenario_json(const net::Net& net, const verify::Report& report,
                                           const verify::PropertyResult& property);

}  // namespace tessera::project
