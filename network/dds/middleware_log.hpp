#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace tessera::dds {

/// From this call on, keeps the log lines of Cyclone DDS instead of letting it write them to standard error:
/// it writes a line for each packet that it cannot read, so any host on the network could fill the disk.
///
/// Threads: any; the same holds for the functions below.
void keep_middleware_log();

/// The newest line, with ": " before it, as the end of a message about a failed call. Empty: there is none
/// since the last call.
[[nodiscard]] std::string take_newest_log_line();

/// A report of the lines logged, at most once a second, with their number and the newest.
[[nodiscard]] std::optional<std::string> middleware_log_report(std::chrono::steady_clock::time_point now);

}  // namespace tessera::dds
