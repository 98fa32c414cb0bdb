#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tessera::cli {

/// An agent of the specification that names a world.
struct WorldAgent {
  std::string path;  ///< "arm", "robot[3]"
  bool in_fleet = false;
};

/// A text in an entry of the contents of a world; empty: the entry has no such key.
[[nodiscard]] inline std::string text_in(const nlohmann::ordered_json& entry, const char* key) {
  return entry.value(key, std::string());
}

/// A section `drivers` for a world, with a buffer for every sensor, camera, joint and actuator. A fleet whose
/// robots have the same elements gets one line for each element: robot[*]. Objects without an agent get none,
/// because no agent can drive them. Empty: there is nothing to drive.
///
/// contents: as contents_of_world gives it. agents: none for a file that stands alone, whose agent is then
/// called `robot`.
[[nodiscard]] std::string drivers_section(const nlohmann::ordered_json& contents,
                                          const std::vector<WorldAgent>& agents);

}  // namespace tessera::cli
