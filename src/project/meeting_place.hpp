#pragma once

#include <string>

#include "project/deployed_run.hpp"
#include "project/process/control_messages.hpp"

namespace tessera::project {

/// Where the processes of a deployment meet, as one sees it who watches from a machine and runs none of them: the
/// interface is that of the processes of this machine; without such, the one that all have.
///
/// options: what differs. Throws std::runtime_error for a domain that is none.
[[nodiscard]] Snapshot::Deployment meeting_place(const spec::Deployment& deployment,
                                                 const NetworkOptions& options, const std::string& machine);

/// The domain of a run with these options. Throws as above.
[[nodiscard]] std::uint32_t domain_of(const spec::Deployment& deployment, const NetworkOptions& options);

}  // namespace tessera::project
