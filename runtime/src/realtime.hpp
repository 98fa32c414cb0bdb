#pragma once

#include <span>
#include <string>

#include "tessera/tables.hpp"

namespace tessera {

/// Gives the calling thread the scheduling that its subsystem asks for, and touches its stack, so that no
/// page fault comes later. Empty, or what was not permitted.
[[nodiscard]] std::string schedule_this_thread(const RealTime& wanted);

/// Keeps the memory of the process in RAM from now on. Empty, or why that was not permitted.
[[nodiscard]] std::string lock_memory();

[[nodiscard]] bool wants_realtime(std::span<const Instance> instances);

}  // namespace tessera
