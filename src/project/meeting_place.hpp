#pragma once

#include <string>

#include "project/deployed_run.hpp"
#include "tessera/control_messages.hpp"

namespace tessera::project {

/// The network on which the processes of a deployment meet, for a machine that runs none of them. The interface is that
/// of the processes of this machine; without such, the one that all have.
///
/// options: what differs. Throws std::runtime_error for a domain that is none.
[[nodiscard]] Snapshot::Deployment meeting_place(const spec::Deployment& deployment,
                                                 const NetworkOptions& options, const std::string& machine);

/// The domain of a run with these options. Throws as above.
[[nodiscard]] std::uint32_t domain_of(const spec::Deployment& deployment, const NetworkOptions& options);

}  // namespace tessera::project
