#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bag/channel.hpp"
#include "project/verification/pipeline.hpp"
#include "tessera/recording.hpp"

/// Bags: MCAP files beside the recordings of Tessera.
namespace tessera::cli {

/// The program, as the header of a bag names it.
inline constexpr const char* bag_library = "tessera " TESSERA_VERSION;
inline constexpr const char* bag_extension = ".mcap";

/// The things that a bag holds besides a recording: topics and units of the buffers, the files of the specification, the
/// net.
[[nodiscard]] bag::Background background_of(const project::Specification& specification, const net::Net& net);
/// The same, with the net of the specification, which has been built before.
[[nodiscard]] bag::Background background_of(const project::Specification& specification);

/// Writes a recording as a bag. specification: its file; empty: it was not found, so that the bag has no messages of ROS 2.
/// Throws std::runtime_error if the file cannot be written.
void write_bag(const Recording& recording, const std::string& specification, const std::string& file);

/// The same of the file of a recording, whatever its length, with little memory. Says on standard error if its beginning is
/// gone. false: nothing was written, since the file, or the newest segment, cannot be read.
[[nodiscard]] bool write_bag_of_file(const std::string& recording, const std::string& specification,
                                     const std::string& file);

/// A recording, or one that stands in a bag.
struct ReadRun {
  Recording recording;
  /// Messages of a bag that do not show this recording; empty: there are none.
  std::vector<std::string> differences;
};
/// nullopt and `error`: the file cannot be read. Says on standard error if the file is damaged or cut off, and prints the
/// differences.
[[nodiscard]] std::optional<ReadRun> read_run(const std::string& file, std::string& error);

/// Writes the recording that stands in a bag as a file. nullopt: as it was: the file is no bag. Throws std::runtime_error if
/// it cannot be read or written, or if the bag shows another run.
[[nodiscard]] std::optional<std::string> unpacked(const std::string& file, const std::string& folder);

/// The values of the real inputs for a simulated run, as the file that controllers read.
struct RunInputs {
  std::string file;
  std::string duration;  ///< up to the last value: "12.5s"
};
/// file: a recording, a bag with one, or a bag that another program has written. Says on standard error which inputs
/// get no values. Throws std::runtime_error: it cannot be used.
[[nodiscard]] RunInputs inputs_of_run(const project::Specification& specification, const std::string& file,
                                      const std::string& folder);

}  // namespace tessera::cli
