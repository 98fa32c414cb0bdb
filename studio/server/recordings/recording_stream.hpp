#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>

#include "tessera/growing_recording.hpp"
#include "tessera/recording.hpp"

namespace tessera::server {

/// The entries of a recording as they are written, from any source, in any number of segments.
class RecordingStream {
 public:
  /// Returns the bytes that were written since the last call.
  using Source = std::function<GrowingRecording::Piece()>;
  /// A file on this machine.
  [[nodiscard]] static Source of_file(const std::filesystem::path& file, GrowingRecording::From from);

  explicit RecordingStream(Source source) : source_(std::move(source)) {}

  /// Reads a piece. false: there was nothing new.
  bool next();
  /// The header of the segment, and the entries of the last piece. nullptr: there is no header yet.
  [[nodiscard]] const std::shared_ptr<const Recording>& recording() const { return recording_; }
  /// Whether the last `next` began a segment: `recording` is another object than before, in the same run.
  [[nodiscard]] bool begins() const { return begins_; }
  /// Whether more can be read at once.
  [[nodiscard]] bool more() const { return more_; }
  /// Whether a segment was damaged, or the end of the last one is missing: it was cut off, or is still being
  /// written.
  [[nodiscard]] bool is_cut() const { return damaged_ || (reader_ && is_cut(*reader_)); }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  [[nodiscard]] static bool is_cut(const RecordingReader& reader) {
    return reader.problem() || !reader.has_ended() || reader.pending() > 0;
  }
  Source source_;
  std::shared_ptr<RecordingReader> reader_;
  std::shared_ptr<const Recording> recording_;
  bool begins_ = false, more_ = false, damaged_ = false;
  std::uint64_t bytes_ = 0;
};

/// Reads a recording from its oldest part on for as long as `part` needs more: part.begin(header) at each
/// segment, part.add(entry) -> bool, and part.end(complete): whether the recording was read to its end.
/// Throws std::runtime_error if the file is no recording.
template <class Part>
void read_part(const std::filesystem::path& file, Part& part) {
  RecordingStream stream(RecordingStream::of_file(file, GrowingRecording::From::oldest));
  bool goes_on = true;
  while (goes_on && stream.next()) {
    if (stream.begins()) part.begin(*stream.recording());
    if (!stream.recording()) continue;
    for (const Recording::Entry& entry : stream.recording()->entries)
      if (!(goes_on = part.add(entry))) break;
  }
  if (!stream.recording()) throw std::runtime_error(file.filename().string() + " is no recording");
  part.end(goes_on);
}

}  // namespace tessera::server
