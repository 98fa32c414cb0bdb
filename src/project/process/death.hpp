#pragma once

#include <filesystem>
#include <string>

#include "project/process/process.hpp"

namespace tessera::project {

/// The message about a controller that has left no summary: "the controller was killed by SIGSEGV at
/// address 0x0 in robot.control.follow". It names the devices that nothing has made safe. Empty: it could not start,
/// and has said why.
///
/// note: the file in which the controller left a note, if it could (RunOptions::death_note).
[[nodiscard]] std::string describe_death(const Exit& exit, const std::filesystem::path& note);

}  // namespace tessera::project
