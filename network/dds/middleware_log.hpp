#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace tessera::dds {

/// From now on, keeps what Cyclone DDS logs instead of letting it write to standard error: it writes a line
/// for each packet that it cannot read, so that anybody on the network could fill the disk.
///
/// Threads: any, as those of the functions below.
void keep_middleware_log();

/// The newest line, with ": " before it, for a message that says that a call has failed. Empty: there is none since
/// the last time.
[[nodiscard]] std::string take_newest_log_line();

/// What to tell a person of what has been logged: once a second at most, with the number of lines and the newest.
[[nodiscard]] std::optional<std::string> tell_of_middleware_log(std::chrono::steady_clock::time_point now);

}  // namespace tessera::dds
