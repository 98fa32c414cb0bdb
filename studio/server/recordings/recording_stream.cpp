#include "server/recordings/recording_stream.hpp"

namespace tessera::server {

RecordingStream::Source RecordingStream::of_file(const std::filesystem::path& file,
                                                 GrowingRecording::From from) {
  constexpr std::size_t piece = std::size_t{1} << 20U;
  return [growing = std::make_shared<GrowingRecording>(file, from)] { return growing->next(piece); };
}

bool RecordingStream::next() {
  if (reader_) reader_->recording().entries.clear();
  const GrowingRecording::Piece piece = source_();
  begins_ = false;
  more_ = piece.more;
  if (piece.bytes.empty()) return false;
  if (piece.begins || !reader_) {
    damaged_ = is_cut();
    reader_ = std::make_shared<RecordingReader>();
    recording_ = nullptr;
  }
  bytes_ += piece.bytes.size();
  reader_->feed(piece.bytes);
  if (recording_ || !reader_->has_header()) return true;
  begins_ = true;
  recording_ = {reader_, &reader_->recording()};
  return true;
}

}  // namespace tessera::server
