#include "recorder.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include "waker.hpp"

namespace tessera {
namespace {

constexpr std::string_view magic = "TESSREC1";
constexpr std::int64_t drain_period_ns = 5'000'000;
static_assert(std::endian::native == std::endian::little, "recordings are little-endian");

}  // namespace

// ------------------------------------------------------------------------------------------------ file

bool RecordingFile::open(const std::string& path, std::string_view header, std::string& error) {
  descriptor_ = ::open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0644);
  if (descriptor_ < 0) {
    error = fmt::format("cannot record to '{}': {}", path, std::strerror(errno));
    return false;
  }
  const auto length = static_cast<std::uint32_t>(header.size());
  std::string start(magic);
  start.append(reinterpret_cast<const char*>(&length), sizeof length);
  start.append(header);
  start.resize((start.size() + 7) / 8 * 8, '\0');
  write_all(start.data(), start.size());
  return true;
}

RecordingFile::~RecordingFile() { close(); }

void RecordingFile::append(const Event& event) {
  if (!failure_.empty()) {
    ++lost_;
    return;
  }
  buffer_[filled_++] = event;
  if (filled_ == buffer_.size()) flush();
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
  while (count > 0 && failure_.empty()) {
    const ssize_t written = write(descriptor_, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      failure_ = std::strerror(errno);
    } else {
      bytes += written;
      count -= static_cast<std::size_t>(written);
    }
  }
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
  if (!has_room(1)) return;
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

void RecordingLane::drain() {
  const std::uint64_t end = published_.load(std::memory_order_acquire);
  std::uint64_t next = drained_.load(std::memory_order_relaxed);
  while (next != end) file_.append(ring_[next++ & (ring_.size() - 1)]);
  drained_.store(next, std::memory_order_release);
}

// ------------------------------------------------------------------------------------------------ recorder

std::unique_ptr<Recorder> Recorder::open(const std::string& path, std::string_view header,
                                         std::uint32_t instances, Mode mode, std::string& error,
                                         std::size_t longest) {
  std::unique_ptr<Recorder> recorder(new Recorder);
  if (!recorder->file_.open(path, header, error)) return nullptr;
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
  while (closing_.load(std::memory_order_acquire) == 0) {
    for (const auto& lane : lanes_) lane->drain();
    file_.flush();
    never.sleep(never.ticket(), monotonic_ns() + drain_period_ns);
  }
}

Recorder::Result Recorder::close() {
  closing_.store(1, std::memory_order_release);
  if (writer_.joinable()) {
    writer_.join();
    for (const auto& lane : lanes_) lane->drain();
  }
  file_.close();
  Result result{.lost = file_.lost(), .failure = file_.failure()};
  for (const auto& lane : lanes_) result.lost += lane->lost();
  return result;
}

}  // namespace tessera
