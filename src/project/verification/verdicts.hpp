#pragma once

#include <string>

#include "project/verification/pipeline.hpp"

/// The verdicts on a net from which a controller is made. They are proved once and
/// kept in the state folder.
namespace tessera::project {

/// "60s", "500ms", "2min" or seconds. Throws std::runtime_error that names `option` for anything else.
[[nodiscard]] double seconds_of(const std::string& text, const std::string& option);

/// The verdicts on a net made by `build`. Stored verdicts are used if they exist and no more time is
/// allowed now for what they leave unknown; otherwise the net is verified. A file of verdicts that cannot
/// be read or written is ignored.
[[nodiscard]] verify::Report verdicts(const Specification& specification, const Nets& nets, const Gate& gate,
                                      Listener& listener);

}  // namespace tessera::project
