#pragma once

#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::project {

/// Checks that the receptors and effectors of services and actions of ROS 2 make whole clients and servers. They
/// belong together if their agent, their service or action and their role are the same.
///
/// Errors: E322 a server without a receptor or an effector, a client without an effector, two of one kind, or
///         two that differ in the type, the node, the network or the time; E371 a client of an action whose safe
///         command orders a goal. false after one of them.
bool check_services(const spec::Model& model, const std::vector<spec::Driver>& drivers,
                    diagnostics::Diagnostics& out);

}  // namespace tessera::project
