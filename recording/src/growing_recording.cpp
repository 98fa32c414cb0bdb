#include "tessera/growing_recording.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "segment_field.hpp"
#include "tessera/recording.hpp"

namespace tessera {
namespace {

/// nullopt: the file does not exist, or its header is not complete yet.
[[nodiscard]] std::optional<std::string> header_at(int descriptor) {
  std::array<char, 12> start{};
  std::uint32_t length = 0;
  if (pread(descriptor, start.data(), start.size(), 0) != static_cast<ssize_t>(start.size()) ||
      !std::string_view(start.data(), start.size()).starts_with(recording_magic))
    return std::nullopt;
  std::memcpy(&length, start.data() + recording_magic.size(), sizeof length);
  struct stat status {};
  if (length > longest_recording_header || fstat(descriptor, &status) != 0 ||
      status.st_size < static_cast<off_t>(start.size() + length))
    return std::nullopt;
  std::string header(length, '\0');
  if (pread(descriptor, header.data(), length, start.size()) != static_cast<ssize_t>(length))
    return std::nullopt;
  return header;
}

}  // namespace

GrowingRecording::GrowingRecording(std::string file, From from) : path_(std::move(file)), from_(from) {}

GrowingRecording::~GrowingRecording() {
  if (file_.descriptor >= 0) close(file_.descriptor);
}

/// The descriptor is -1 if there is no complete header yet.
GrowingRecording::File GrowingRecording::open(const std::string& file) {
  File opened{.descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK),
              .run = {},
              .segment = {}};
  if (opened.descriptor < 0) return opened;
  const std::optional<std::string> header = header_at(opened.descriptor);
  if (!header) {
    close(std::exchange(opened.descriptor, -1));
    return opened;
  }
  opened.run = without_segment(*header);
  opened.segment = segment_in(*header);
  return opened;
}

void GrowingRecording::take(File file) {
  if (file_.descriptor >= 0) close(file_.descriptor);
  file_ = std::move(file);
  begins_ = file_.descriptor >= 0;
}

void GrowingRecording::begin() {
  take(open(path_));
  while (from_ == From::oldest && file_.segment.value_or(0) > 0) {
    File before = open(segment_path(path_, *file_.segment - 1));
    const bool of_this_run = before.descriptor >= 0 && before.run == file_.run;
    if (!of_this_run && before.descriptor >= 0) close(before.descriptor);
    if (!of_this_run) return;
    take(std::move(before));
  }
}

/// Whether another file is being written now, so that this one is complete.
bool GrowingRecording::is_full() const {
  struct stat ours {
  }, newest{};
  return file_.segment && fstat(file_.descriptor, &ours) == 0 && lstat(path_.c_str(), &newest) == 0 &&
         (ours.st_ino != newest.st_ino || ours.st_dev != newest.st_dev);
}

/// Continues with the segment after this one, or, if that is gone already, with the newest.
void GrowingRecording::go_on() {
  const std::string after = segment_path(path_, *file_.segment + 1);
  File next = open(after);
  if (next.descriptor < 0) {
    next = open(path_);
    // Checks whether the segment has got its number between the two calls.
    if (File numbered = open(after); numbered.descriptor >= 0) {
      if (next.descriptor >= 0) close(next.descriptor);
      next = std::move(numbered);
    }
  }
  if (next.descriptor < 0) return;
  const bool of_this_run = next.run == file_.run && next.segment > file_.segment;
  if (of_this_run) return take(std::move(next));
  close(next.descriptor);
}

std::string GrowingRecording::read_some(std::size_t most) const {
  std::string bytes(most, '\0');
  const ssize_t count = read(file_.descriptor, bytes.data(), most);
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return bytes;
}

GrowingRecording::Piece GrowingRecording::next(std::size_t most) {
  if (file_.descriptor < 0) begin();
  Piece piece;
  if (file_.descriptor < 0) return piece;
  piece.bytes = read_some(most);
  if (piece.bytes.empty() && is_full()) {
    piece.bytes = read_some(most);  // the segment before it was full
    if (piece.bytes.empty()) {
      go_on();
      piece.bytes = read_some(most);
    }
  }
  if (piece.bytes.empty()) return piece;
  piece.begins = std::exchange(begins_, false);
  piece.more = piece.bytes.size() == most || is_full();
  return piece;
}

}  // namespace tessera
