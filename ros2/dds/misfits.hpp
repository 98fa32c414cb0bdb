#pragma once

#include <dds/dds.h>

#include <string>
#include <vector>

namespace tessera::ros2 {

/// Why the other endpoints of a topic cannot be matched with ours: another type, or a policy of the quality of
/// service, with the values of both sides. One text for each reason, such as
/// "a publisher of /scan offers reliability best_effort, and ours requests reliable".
///
/// topic: "/scan"; dds_topic, dds_type: as DDS names them. Empty: all that were found fit, or cannot be read.
/// Threads: any. It makes a reader, so it is for rare use.
[[nodiscard]] std::vector<std::string> misfits(dds_entity_t participant, dds_entity_t own, bool writes,
                                               const std::string& topic, const std::string& dds_topic,
                                               const std::string& dds_type);

}  // namespace tessera::ros2
