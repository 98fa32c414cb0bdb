#pragma once

#include <filesystem>
#include <string>

#include "project/process/process.hpp"

namespace tessera::project {

/// What there is to say of a controller that has left no summary: "the controller was killed by SIGSEGV at
/// address 0x0 in robot.control.follow". Empty: it could not start, and has said why.
///
/// note: what the controller has left there (RunOptions::death_note), if it could.
[[nodiscard]] std::string describe_death(const Exit& exit, const std::filesystem::path& note);

}  // namespace tessera::project
