#include "recorder.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>

#include "stop_signals.hpp"
#include "waker.hpp"

namespace tessera {
namespace {

constexpr std::int64_t drain_period_ns = 5'000'000;
constexpr std::int64_t patience_ns = 2'000'000'000;  // at the end, with a pipe that nobody reads
constexpr int look_up_ms = 50;
static_assert(std::endian::native == std::endian::little, "recordings are little-endian");

}  // namespace

// ------------------------------------------------------------------------------------------------ file

namespace {

/// Segments that an earlier recording of that name has left would be read with this one. Other files of such
/// a name are not ours to remove or to write over: false and `error`.
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
    if (!number || fs::path(segment_path(path, *number)).filename() != entry.path().filename()) {
      error = fmt::format("'{}' is in the way: a recording with a limit leaves files of such names", name);
      return false;
    }
    segments.push_back(entry.path());
  }
  for (const fs::path& segment : segments) fs::remove(segment, ignored);
  return true;
}

}  // namespace

bool RecordingFile::open(const std::string& path, std::string_view header, std::string& error,
                         RunOptions::Limit limit, std::unique_ptr<MarkingTrack> track) {
  path_ = path;
  header_ = header;
  limit_ = limit;
  track_ = limit.segment_bytes == 0 ? nullptr : std::move(track);
  if (track_ != nullptr) {
    const std::size_t least = 2 * header.size() + 64 * sizeof(Event);
    if (limit.segment_bytes < least || limit.segments < 2) {
      error =
          fmt::format("the limit of the recording is too small: it needs two segments of {} bytes", least);
      return false;
    }
    if (!remove_segments(path, error)) return false;
  }
  if (open_segment()) return true;
  error = fmt::format("cannot record to '{}': {}", path, std::strerror(errno));
  return false;
}

/// The file and its header.
bool RecordingFile::open_segment() {
  descriptor_ = ::open(path_.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0644);
  if (descriptor_ < 0) return false;
  if (struct stat status{}; fstat(descriptor_, &status) == 0 && !S_ISREG(status.st_mode))
    fcntl(descriptor_, F_SETFL, fcntl(descriptor_, F_GETFL) | O_NONBLOCK);
  std::string header = header_;
  if (track_ != nullptr) {
    header.pop_back();
    header += fmt::format(",\"segment\":{}}}", segment_);
  }
  const auto length = static_cast<std::uint32_t>(header.size());
  std::string start;
  start.reserve(recording_magic.size() + sizeof length + header.size() + 8);  // with the padding
  start.append(recording_magic);
  start.append(reinterpret_cast<const char*>(&length), sizeof length);
  start.append(header);
  start.resize((start.size() + 7) / 8 * 8, '\0');
  segment_bytes_ = start.size();
  write_all(start.data(), start.size());
  return true;
}

RecordingFile::~RecordingFile() { close(); }

void RecordingFile::append(const Event& event) {
  if (!failure_.empty()) {
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

/// Each segment ends with an event that says so.
void RecordingFile::keep_track(const Event& event) {
  if (segment_bytes_ + (2 + event.pieces()) * sizeof(Event) > limit_.segment_bytes)
    begin_segment(event.time_ns);
  if (event.kind() == Event::Kind::firing) track_->fire(event);
}

void RecordingFile::put_end(std::uint64_t lost, bool goes_on) {
  put({.time_ns = last_ns_,
       .subject = static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, UINT32_MAX)),
       .version = goes_on ? 1U : 0U,
       .origin = system_instance << 8U | static_cast<std::uint32_t>(Event::Kind::end)});
}

void RecordingFile::put_end(std::uint64_t lost) {
  if (failure_.empty()) put_end(lost, /*goes_on=*/false);
}

/// The last one gets its number, the one that is too old goes.
void RecordingFile::begin_segment(std::int64_t time_ns) {
  put_end(0, /*goes_on=*/true);
  flush();
  if (!failure_.empty()) return;
  ::close(descriptor_);
  descriptor_ = -1;
  if (std::rename(path_.c_str(), segment_path(path_, segment_).c_str()) != 0) failure_ = std::strerror(errno);
  ++segment_;
  if (segment_ >= limit_.segments) ::unlink(segment_path(path_, segment_ - limit_.segments).c_str());
  if (failure_.empty() && !open_segment()) failure_ = std::strerror(errno);
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
  if (!failure_.empty()) lost_ += filled_;
  filled_ = 0;
}

void RecordingFile::close() {
  if (descriptor_ < 0) return;
  flush();
  if (::close(descriptor_) != 0 && failure_.empty()) failure_ = std::strerror(errno);
  descriptor_ = -1;
}

void RecordingFile::write_all(const char* bytes, std::size_t count) {
  std::int64_t stuck_ns = 0;
  while (count > 0 && failure_.empty()) {
    const ssize_t written = write(descriptor_, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno == EAGAIN) {
      await_room(stuck_ns);
      continue;
    }
    stuck_ns = 0;
    if (written < 0) {
      failure_ = std::strerror(errno);
    } else {
      bytes += written;
      count -= static_cast<std::size_t>(written);
    }
  }
}

/// Of a pipe. Its reader may be slow; once the run is at its end it must read on, or lose the rest.
void RecordingFile::await_room(std::int64_t& stuck_ns) {
  pollfd room{.fd = descriptor_, .events = POLLOUT, .revents = 0};
  if (poll(&room, 1, look_up_ms) > 0) return;
  if (!hurry_.load(std::memory_order_relaxed) && StopSignals::pending() == 0) return;
  const std::int64_t now_ns = monotonic_ns();
  if (stuck_ns == 0) stuck_ns = now_ns;
  if (now_ns - stuck_ns > patience_ns) failure_ = "nobody reads it";
}

// ------------------------------------------------------------------------------------------------ lane

RecordingLane::RecordingLane(std::uint32_t instance, RecordingFile& file, std::size_t capacity)
    : instance_(instance), file_(file), ring_(capacity == 0 ? 0 : std::bit_ceil(capacity)) {}

Event RecordingLane::event(Event::Kind kind, Time time) {
  return {.time_ns = time.time_since_epoch().count(),
          .sequence = sequence_++,
          .origin = instance_ << 8 | static_cast<std::uint32_t>(kind)};
}

void RecordingLane::firing(Time time, std::uint32_t transition, std::uint32_t version) {
  Event fired = event(Event::Kind::firing, time);
  if (!has_room(1)) return has_lost_firings_.store(true, std::memory_order_relaxed);
  fired.subject = transition;
  fired.version = version;
  push(fired);
  publish();
}

void RecordingLane::overrun(Time time, std::uint32_t missed) {
  Event late = event(Event::Kind::overrun, time);
  if (!has_room(1)) return;
  late.subject = missed;
  push(late);
  publish();
}

void RecordingLane::text(Event::Kind kind, Time time, std::uint32_t level, std::string_view text) {
  Event head = event(kind, time);
  if (!has_room(1 + (text.size() + sizeof(Event) - 1) / sizeof(Event))) return;
  head.subject = static_cast<std::uint32_t>(text.size());
  head.version = level;
  push(head);
  push_bytes(text.data(), text.size());
  publish();
}

void RecordingLane::call(Time time, std::uint32_t behaviour, std::uint64_t iteration) {
  Event begun = event(Event::Kind::call, time);
  if (!has_room(1)) return;
  begun.subject = behaviour;
  begun.version = static_cast<std::uint32_t>(iteration);
  push(begun);
  publish();
}

void RecordingLane::value(Time time, std::uint32_t buffer, std::uint32_t flags,
                          std::span<const std::byte> head, std::span<const std::byte> bytes) {
  Event changed = event(Event::Kind::value, time);
  const std::size_t size = head.size() + bytes.size();
  if (!has_room(1 + (size + sizeof(Event) - 1) / sizeof(Event))) return;
  changed.subject = static_cast<std::uint32_t>(size);
  changed.version = buffer | flags << 24U;
  push(changed);
  if (!head.empty()) {
    std::array<std::byte, sizeof(Event)> first{};
    const std::size_t count = std::min(bytes.size(), first.size() - head.size());
    std::copy(head.begin(), head.end(), first.begin());
    std::copy_n(bytes.begin(), count, first.begin() + static_cast<std::ptrdiff_t>(head.size()));
    push_bytes(first.data(), head.size() + count);
    bytes = bytes.subspan(count);
  }
  push_bytes(bytes.data(), bytes.size());
  publish();
}

bool RecordingLane::has_room(std::uint64_t count) {
  if (ring_.empty()) return true;
  if (pushed_ - seen_drained_ + count > ring_.size())
    seen_drained_ = drained_.load(std::memory_order_acquire);
  if (pushed_ - seen_drained_ + count <= ring_.size()) return true;
  ++lost_;
  return false;
}

void RecordingLane::push(const Event& event) {
  if (ring_.empty())
    file_.append(event);
  else
    ring_[pushed_++ & (ring_.size() - 1)] = event;
}

/// In pieces of the size of an event, the last filled up.
void RecordingLane::push_bytes(const void* bytes, std::size_t count) {
  const auto* next = static_cast<const char*>(bytes);
  while (count > 0) {
    Event piece{};
    const std::size_t taken = std::min(count, sizeof piece);
    std::memcpy(&piece, next, taken);
    push(piece);
    next += taken;
    count -= taken;
  }
}

void RecordingLane::publish() { published_.store(pushed_, std::memory_order_release); }

bool RecordingLane::drain(bool in_order) {
  const std::uint64_t begin = drained_.load(std::memory_order_relaxed);
  const std::uint64_t end = published_.load(std::memory_order_acquire);
  std::uint64_t next = begin;
  while (next != end) {
    const Event& head = ring_[next & (ring_.size() - 1)];
    if (in_order && head.kind() == Event::Kind::firing && !file_.track()->may_fire(head)) break;
    for (const std::uint64_t after = next + 1 + head.pieces(); next != after; ++next)
      file_.append(ring_[next & (ring_.size() - 1)]);
  }
  drained_.store(next, std::memory_order_release);
  return next != begin;
}

RecordingLane::Backlog RecordingLane::backlog() const {
  const std::uint64_t left =
      published_.load(std::memory_order_acquire) - drained_.load(std::memory_order_relaxed);
  return {.waits = left > 0,
          .is_high = left > ring_.size() / 4 * 3,
          .has_lost = has_lost_firings_.load(std::memory_order_relaxed)};
}

// ------------------------------------------------------------------------------------------------ recorder

std::unique_ptr<Recorder> Recorder::open(const std::string& path, std::string_view header,
                                         std::uint32_t instances, Mode mode, std::string& error,
                                         std::size_t longest, RunOptions::Limit limit,
                                         std::unique_ptr<MarkingTrack> track) {
  std::unique_ptr<Recorder> recorder(new Recorder);
  if (!recorder->file_.open(path, header, error, limit, std::move(track))) return nullptr;
  // About 24 MB of rings, up to a quarter of a second at a million events a second for each.
  const std::size_t least = std::max<std::size_t>(512, 8 * longest / sizeof(Event));
  const std::size_t capacity =
      mode == Mode::direct
          ? 0
          : std::max(least, std::min((std::size_t{1} << 20) / (instances + 1), std::size_t{1} << 18));
  for (std::uint32_t instance = 0; instance < instances; ++instance)
    recorder->lanes_.push_back(std::make_unique<RecordingLane>(instance, recorder->file_, capacity));
  recorder->lanes_.push_back(std::make_unique<RecordingLane>(system_instance, recorder->file_, capacity));
  if (mode == Mode::threaded)
    recorder->writer_ = std::thread([raw = recorder.get()] { raw->write_until_closed(); });
  return recorder;
}

Recorder::~Recorder() {
  if (writer_.joinable()) static_cast<void>(close());
}

void Recorder::write_until_closed() {
  WakeWord never;  // only its timeout ends the wait: producers must not pay for waking a writer
  try {
    while (closing_.load(std::memory_order_acquire) == 0) {
      drain();
      file_.flush();
      never.sleep(never.ticket(), monotonic_ns() + drain_period_ns);
    }
  } catch (const std::exception& exception) {  // no memory: what comes now is lost, and counted
    file_.fail(exception.what());
  }
}

void Recorder::drain() {
  if (file_.track() != nullptr) return drain_in_order();
  for (const auto& lane : lanes_) lane->drain();
}

/// Segments can be checked by themselves because every firing comes after those it follows from. A firing
/// waits for those as long as its thread and theirs need, however busy the machine is: only when one of them
/// is lost, or events are soon lost, the rest is written as it comes.
void Recorder::drain_in_order() {
  bool moved = true, give_up = false;
  while (moved && !give_up) {
    moved = false;
    for (const auto& lane : lanes_) {
      const bool this_one = lane->drain(/*in_order=*/true);
      moved = moved || this_one;
      give_up = give_up || (!this_one && lane->backlog().is_high);
    }
  }
  if (!give_up && !waits_for_what_is_lost()) return;
  file_.forget_marking();
  for (const auto& lane : lanes_) lane->drain();
}

bool Recorder::waits_for_what_is_lost() const {
  const auto any = [&](bool RecordingLane::Backlog::*what) {
    return std::ranges::any_of(lanes_, [&](const auto& lane) { return lane->backlog().*what; });
  };
  return any(&RecordingLane::Backlog::has_lost) && any(&RecordingLane::Backlog::waits);
}

Recorder::Result Recorder::close() {
  closing_.store(1, std::memory_order_release);
  if (writer_.joinable()) {
    file_.hurry();
    writer_.join();
    drain();
    for (const auto& lane : lanes_) lane->drain();
  }
  std::uint64_t lost = file_.lost();
  for (const auto& lane : lanes_) lost += lane->lost();
  file_.put_end(lost);
  file_.close();
  if (!file_.failure().empty()) {  // of closing too
    lost = file_.lost();
    for (const auto& lane : lanes_) lost += lane->lost();
  }
  return {.lost = lost, .failure = file_.failure()};
}

}  // namespace tessera
