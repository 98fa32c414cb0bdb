#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "nets/flat_net.hpp"
#include "recorder/recorder.hpp"
#include "subsystem/subsystem_parts.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// The JSON at the beginning of a recording (tessera/recording.hpp): the net, and with values also what
/// `simulate --from` needs to know.
[[nodiscard]] std::string recording_header(const System& system, const RunOptions& options,
                                           const FlatNet& net, std::span<const SubsystemParts> parts);

/// The most bytes that a value takes in the recording; 0: values are not recorded.
[[nodiscard]] std::size_t longest_recorded_value(const RunOptions& options,
                                                 std::span<const SubsystemParts> parts);

/// Gives each subsystem its recorder of values, if they are recorded.
void record_values(const RunOptions& options, Recorder& recorder, std::span<SubsystemParts> parts);

}  // namespace tessera
