#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::project {

/// Looks up the messages of all drivers that are topics, services, actions or transforms of ROS 2: in the folder `msg`
/// of the project, then in the installations of ROS 2 that AMENT_PREFIX_PATH names, then among those that come with
/// Tessera. Their definitions become the option `definition` of the drivers, so that a controller needs no file of
/// them.
///
/// project: the folder of the specification.
/// Errors: E218 a unit that the messages of the package do not have; E320 a message that does not exist, or whose
///         definition is wrong; E321 fields of message and buffer that do not correspond; E322 services
///         and actions, E371 a safe command that orders a goal (ros2_services.hpp). false after one of them. Also
///         W341 a definition of the project that is not that of an installation.
bool find_messages(spec::Model& model, const std::filesystem::path& project, diagnostics::Diagnostics& out);
/// The same with these folders of definitions: that of the project, those of installations, that of Tessera.
bool find_messages_in(spec::Model& model, const std::vector<std::filesystem::path>& folders,
                      diagnostics::Diagnostics& out);

/// Changes when a definition in the project is added, removed or edited.
[[nodiscard]] std::string state_of_messages(const std::filesystem::path& project);

/// A text among the options of a driver; empty: there is none.
[[nodiscard]] std::string text_option(const spec::Driver& driver, const char* name);
/// Whether a driver of kind ros2 is one side of a service or action, and not a topic.
[[nodiscard]] bool has_role(const spec::Driver& driver);
/// Whether it gives or broadcasts the transform between two frames.
[[nodiscard]] bool is_transform(const spec::Driver& driver);
/// Whether it is one side of an action.
[[nodiscard]] bool is_action(const spec::Driver& driver);
/// Whether it stands behind an effector, and not behind a receptor.
[[nodiscard]] bool is_effector(const spec::Model& model, const spec::Driver& driver);

}  // namespace tessera::project
