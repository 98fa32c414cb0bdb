#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <thread>

#include "recorder/recorder.hpp"
#include "system/stop_signals.hpp"
#include "system/waker.hpp"

namespace tessera {
namespace {

// the wait at the end of the run for a pipe that is not read
constexpr std::int64_t pipe_patience_ns = 2'000'000'000;
constexpr int look_up_ms = 50;
static_assert(std::endian::native == std::endian::little, "recordings are little-endian");

/// Removes segments of an earlier recording with that name, which would be read together with this one.
/// Other files with such a name are neither removed nor overwritten, nor is a recording of a run that has ended
/// in it: false and `error`.
bool remove_segments(const std::string& path, std::string& error) {
  namespace fs = std::filesystem;
  const fs::path whole(path);
  std::error_code ignored;
  std::vector<fs::path> segments;
  const fs::path folder = whole.has_parent_path() ? whole.parent_path() : fs::path(".");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().string();
    if (fs::path(without_segment_number(name)).filename() != whole.filename()) continue;
    const auto number = segment_number_in(name);
    const bool is_segment =
        number && fs::path(segment_path(path, *number)).filename() == entry.path().filename();
    if (!is_segment || end_of(name) == FileEnd::final) {
      error = fmt::format(
          "'{}' is in the way: a recording with a limit leaves files of such names\n"
          "hint: name another file with --record, or keep all in one file with --record-limit none",
          name);
      return false;
    }
    segments.push_back(entry.path());
  }
  for (const fs::path& segment : segments) fs::remove(segment, ignored);
  return true;
}

/// Keeps other runs from writing into the file. false: one does, and errno is EWOULDBLOCK. A file system
/// without locks has none. A process that an earlier run has forked may hold the file a moment longer.
[[nodiscard]] bool lock(int descriptor) {
  constexpr int attempts = 50;
  constexpr std::chrono::milliseconds pause{20};
  for (int attempt = 0; flock(descriptor, LOCK_EX | LOCK_NB) != 0; ++attempt) {
    if (errno != EWOULDBLOCK) return true;
    if (attempt == attempts) return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

[[nodiscard]] bool is_pipe_or_device(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

}  // namespace

bool RecordingFile::open(const std::string& path, const RecordingHeader& header, std::string& error,
                         RunOptions::Limit limit, std::unique_ptr<MarkingTrack> track) {
  path_ = path;
  header_ = header.json;
  if (!is_pipe_or_device(path)) limit_ = limit;
  track_ = limit_.segment_bytes == 0 ? nullptr : std::move(track);
  if (!take_file()) {
    error = errno == EWOULDBLOCK
                ? fmt::format("another run records into '{}'\nhint: name another file with --record", path)
                : fmt::format("cannot record to '{}': {}", path, std::strerror(errno));
    return false;
  }
  if (!has_room_for_segments(limit, error)) {
    if (is_empty_) ::unlink(path_.c_str());
    return false;
  }
  begin_file();
  return true;
}

/// false and `error`: the limit is too small, or a file is in the way.
bool RecordingFile::has_room_for_segments(RunOptions::Limit limit, std::string& error) {
  if (track_ != nullptr) {
    const std::size_t least = 2 * header_.size() + 64 * sizeof(Event);
    if (limit.segment_bytes < least || limit.segments < 2) {
      error =
          fmt::format("the limit of the recording is too small: it needs two segments of {} bytes", least);
      return false;
    }
    if (!remove_segments(path_, error)) return false;
    began_ns_.push_back(0);
  }
  return true;
}

/// Opens the file, and leaves its content as it is: another run may be writing it. false: errno says why.
bool RecordingFile::take_file() {
  descriptor_ = ::open(path_.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0644);
  struct stat status {};
  if (descriptor_ < 0 || fstat(descriptor_, &status) != 0) return false;
  if (S_ISREG(status.st_mode)) return lock(descriptor_) && is_still_there();
  is_empty_ = true;
  fcntl(descriptor_, F_SETFL, fcntl(descriptor_, F_GETFL) | O_NONBLOCK);
  return true;
}

/// While this run waited for the lock, another may have made a numbered segment of the file.
bool RecordingFile::is_still_there() {
  struct stat own {
  }, named{};
  if (fstat(descriptor_, &own) != 0) return false;
  is_empty_ = own.st_size == 0;
  if (stat(path_.c_str(), &named) == 0 && own.st_ino == named.st_ino && own.st_dev == named.st_dev)
    return true;
  errno = EWOULDBLOCK;
  return false;
}

/// Empties the file and writes the header.
void RecordingFile::begin_file() {
  if (!is_empty_ && ftruncate(descriptor_, 0) != 0) failure_ = Problem{std::strerror(errno)};
  std::string header = header_;
  if (track_ != nullptr) {
    header.pop_back();
    header += fmt::format(",\"segment\":{}}}", segment_);
  }
  const auto length = static_cast<std::uint32_t>(header.size());
  std::string start;
  start.reserve(recording_magic.size() + sizeof length + header.size() + 8);  // including the padding
  start.append(recording_magic);
  start.append(reinterpret_cast<const char*>(&length), sizeof length);
  start.append(header);
  start.resize((start.size() + 7) / 8 * 8, '\0');
  segment_bytes_ = start.size();
  write_all(start.data(), start.size());
}

RecordingFile::~RecordingFile() { close(); }

void RecordingFile::append(const Event& event) {
  if (failure_) {
    ++lost_;
    return;
  }
  const bool is_head = pieces_left_ == 0;
  if (is_head && track_ != nullptr) keep_track(event);
  pieces_left_ = is_head ? event.pieces() : pieces_left_ - 1;
  if (is_head) last_ns_ = std::max(last_ns_, event.time_ns);
  put(event);
}

void RecordingFile::put(const Event& event) {
  buffer_[filled_++] = event;
  segment_bytes_ += sizeof(Event);
  if (filled_ == buffer_.size()) flush();
}

/// Tracks the marking at the ends of segments.
void RecordingFile::keep_track(const Event& event) {
  if (segment_bytes_ + (2 + event.pieces()) * sizeof(Event) > limit_.segment_bytes)
    begin_segment(event.time_ns);
  if (event.kind() == Event::Kind::firing) track_->fire(event);
  // The tokens that a process held are gone when it begins again.
  if (event.kind() == Event::Kind::process) track_->forget();
}

void RecordingFile::put_end(std::uint64_t lost, bool goes_on) {
  put({.time_ns = last_ns_,
       .subject = static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, UINT32_MAX)),
       .version = goes_on ? 1U : 0U,
       .origin = system_instance << 8U | static_cast<std::uint32_t>(Event::Kind::end)});
}

void RecordingFile::put_end(std::uint64_t lost) {
  if (!failure_) put_end(lost, /*goes_on=*/false);
}

/// Gives the last segment its number, and removes the oldest one if there are too many.
void RecordingFile::begin_segment(std::int64_t time_ns) {
  put_end(0, /*goes_on=*/true);
  flush();
  if (failure_) return;
  ::close(descriptor_);
  descriptor_ = -1;
  if (std::rename(path_.c_str(), segment_path(path_, segment_).c_str()) != 0)
    failure_ = Problem{std::strerror(errno)};
  ++segment_;
  began_ns_.push_back(time_ns);
  if (segment_ >= limit_.segments) {
    ::unlink(segment_path(path_, segment_ - limit_.segments).c_str());
    began_ns_.pop_front();
  }
  if (!failure_ && !take_file()) failure_ = Problem{std::strerror(errno)};
  if (!failure_) begin_file();
  const std::string marked = track_->known() ? track_->marked() : std::string();
  put({.time_ns = time_ns,
       .subject = static_cast<std::uint32_t>(marked.size()),
       .version = track_->known() ? 0U : 1U,
       .origin = system_instance << 8U | static_cast<std::uint32_t>(Event::Kind::marking)});
  for (std::size_t at = 0; at < marked.size(); at += sizeof(Event)) {
    Event piece{};
    std::memcpy(&piece, marked.data() + at, std::min(marked.size() - at, sizeof piece));
    put(piece);
  }
}

void RecordingFile::flush() {
  if (filled_ == 0) return;
  write_all(reinterpret_cast<const char*>(buffer_.data()), filled_ * sizeof(Event));
  if (failure_) lost_ += filled_;
  filled_ = 0;
}

void RecordingFile::close() {
  if (descriptor_ < 0) return;
  flush();
  if (::close(descriptor_) != 0 && !failure_) failure_ = Problem{std::strerror(errno)};
  descriptor_ = -1;
}

void RecordingFile::write_all(const char* bytes, std::size_t count) {
  std::int64_t stuck_ns = 0;
  while (count > 0 && !failure_) {
    const ssize_t written = write(descriptor_, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno == EAGAIN) {
      await_room(stuck_ns);
      continue;
    }
    stuck_ns = 0;
    if (written < 0) {
      failure_ = Problem{std::strerror(errno)};
    } else {
      bytes += written;
      count -= static_cast<std::size_t>(written);
    }
  }
}

/// Waits for room in a pipe. Its reader may be slow; but once the run is at its end, the reader must
/// go on, or the rest is lost.
void RecordingFile::await_room(std::int64_t& stuck_ns) {
  pollfd room{.fd = descriptor_, .events = POLLOUT, .revents = 0};
  if (poll(&room, 1, look_up_ms) > 0) return;
  if (!hurry_.load(std::memory_order_relaxed) && StopSignals::pending() == 0) return;
  const std::int64_t now_ns = monotonic_ns();
  if (stuck_ns == 0) stuck_ns = now_ns;
  if (now_ns - stuck_ns > pipe_patience_ns) failure_ = Problem{"its reader is blocked"};
}

}  // namespace tessera
