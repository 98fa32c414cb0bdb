#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "assembly/assembly.hpp"
#include "nets/flat_net.hpp"
#include "subsystem/subsystem_parts.hpp"

namespace tessera {

/// Opens the recording that the options ask for, and gives each subsystem its recorder of values. Its header
/// (tessera/recording.hpp) names the subsystems and transitions of the whole system, whatever part of it
/// runs.
///
/// channels: as MarkingTrack wants them.
/// Errors:   as Recorder::open: false and `error`.
[[nodiscard]] bool open_recording(Assembly& assembly, const Clock& clock, const FlatNet& net,
                                  std::span<SubsystemParts> parts, std::vector<ChannelId> channels,
                                  std::string& error);

/// Larger values are not recorded whole.
[[nodiscard]] std::uint64_t value_limit(const RunOptions& options);

/// Gives one subsystem its recorder of values, if values are recorded. first_buffer, first_memory: the numbers
/// of its first buffer and of its first field of memory in the recording.
void record_values_of(Assembly& assembly, SubsystemParts& parts, std::uint32_t first_buffer,
                      std::uint32_t first_memory);

}  // namespace tessera
