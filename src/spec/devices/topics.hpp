#pragma once

#include <string_view>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// The kind of driver that is a topic of ROS 2, or one side of a service or action.
inline constexpr std::string_view topic_kind = "ros2";

/// Reads { ros2: TOPIC, type: MESSAGE, ... } or { ros2: SERVICE, type: PACKAGE/srv/NAME, role: client, ... }
/// or { ros2: ACTION, type: PACKAGE/action/NAME, ... } into target and options of the driver. The role of an action is
/// `client` unless it says otherwise. The options are texts as tessera/ros2.hpp has them. The message
/// itself is looked up later (project/files/ros2_messages.hpp).
///
/// Errors: E102, E103, E104 keys and forms; E105 names of topics, messages, nodes and hosts; E204 the domain;
///         and the role; E205, E206 times.
void read_topic(const Entry& entry, Driver& driver, Diagnostics& out);

}  // namespace tessera::spec
