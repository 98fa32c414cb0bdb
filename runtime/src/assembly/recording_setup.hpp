#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "nets/flat_net.hpp"
#include "nets/process_part.hpp"
#include "network/messages.hpp"
#include "recorder/recorder.hpp"
#include "subsystem/subsystem_parts.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// The JSON at the beginning of a recording (tessera/recording.hpp): the net, and with values also what
/// `simulate --from` needs to know.
/// scene: nullptr: no poses are recorded.
/// The subsystems and transitions are those of the whole system, whatever part of it runs.
[[nodiscard]] RecordingHeader recording_header(const ProcessPart& part, network::Incarnation incarnation,
                                               const RunOptions& options, const FlatNet& net,
                                               std::span<const SubsystemParts> parts,
                                               const WorldScene* scene);

/// The most bytes that a value, or a frame of poses, takes in the recording; 0: none is recorded.
[[nodiscard]] std::size_t longest_recorded_value(const RunOptions& options,
                                                 std::span<const SubsystemParts> parts,
                                                 const WorldScene* scene);

/// Gives each subsystem its recorder of values, if they are recorded.
void record_values(const RunOptions& options, Recorder& recorder, std::span<SubsystemParts> parts);

}  // namespace tessera
