#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bag/conversion.hpp"
#include "mcap/writer.hpp"

namespace tessera::bag {

/// The metadata of a bag: the run, and the verdicts on its net. recording: its header is needed.
[[nodiscard]] std::vector<mcap::Metadata> metadata_of(const Recording& recording);

/// Makes a bag of a recording: the bytes of an MCAP file, which its user takes and writes.
///
/// Threads: one at a time.
class BagWriter {
 public:
  /// recording: its header is needed, not its entries. library: the name of the program.
  BagWriter(const Recording& recording, const Background& background, const std::string& library);

  /// Precondition: the entry belongs to the recording.
  void add(const Recording::Entry& entry);
  /// Closes the chunk of the messages so far.
  void close_chunk() { writer_.close_chunk(); }
  /// The recording has ended, and has lost so many events.
  void end(std::uint64_t lost);
  /// Writes the index; after `end`, or for a recording without its end. Only `take` may follow.
  void finish() { writer_.finish(); }
  /// All complete records that have not been taken. Those in an open chunk are not among them.
  [[nodiscard]] std::string take() { return writer_.take(); }

 private:
  Conversion conversion_;
  mcap::Writer writer_;
  std::vector<std::uint16_t> channels_;  // of the writer, as those of the conversion
  std::int64_t last_ns_ = 0;
};

}  // namespace tessera::bag
