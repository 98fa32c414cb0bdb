#pragma once

#include <filesystem>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::project {

/// Looks up the messages of all drivers that are topics of ROS 2: in the folder `msg` of the project, then
/// among those that come with Tessera. Their definitions become the option `definition` of the drivers, so
/// that a controller needs no file of them.
///
/// project: the folder of the specification.
/// Errors: E320 a message that does not exist, or whose definition is wrong; E321 fields of message and buffer
///         that do not correspond. false after one of them.
bool find_messages(spec::Model& model, const std::filesystem::path& project, diagnostics::Diagnostics& out);
/// The same with these folders of definitions.
bool find_messages_in(spec::Model& model, const std::vector<std::filesystem::path>& folders,
                      diagnostics::Diagnostics& out);

}  // namespace tessera::project
