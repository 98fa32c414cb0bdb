#include "recorder/recorder.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <exception>

#include "system/waker.hpp"

namespace tessera {
namespace {

constexpr std::int64_t drain_period_ns = 5'000'000;

}  // namespace

// ------------------------------------------------------------------------------------------------ lane

RecordingLane::RecordingLane(std::uint32_t instance, RecordingFile& file, std::size_t capacity,
                             RunTally* tally)
    : instance_(instance), file_(file), tally_(tally), ring_(capacity == 0 ? 0 : std::bit_ceil(capacity)) {}

Event RecordingLane::event(Event::Kind kind, Time time) {
  return {.time_ns = time.time_since_epoch().count(),
          .sequence = sequence_++,
          .origin = instance_ << 8 | static_cast<std::uint32_t>(kind)};
}

void RecordingLane::firing(Time time, std::uint32_t transition, std::uint32_t version) {
  if (tally_ != nullptr) return tally_->fire(transition);
  Event fired = event(Event::Kind::firing, time);
  if (!has_room(1)) return has_lost_firings_.store(true, std::memory_order_relaxed);
  fired.subject = transition;
  fired.version = version;
  push(fired);
  publish();
}

void RecordingLane::overrun(Time time, std::uint32_t missed) {
  if (tally_ != nullptr) return;
  Event late = event(Event::Kind::overrun, time);
  if (!has_room(1)) return;
  late.subject = missed;
  push(late);
  publish();
}

void RecordingLane::text(Event::Kind kind, Time time, std::uint32_t level, std::string_view text) {
  if (tally_ != nullptr) {
    if (kind == Event::Kind::fault)
      tally_->note(instance_, static_cast<Fault>(level & (told_fault - 1)), time, text);
    return;
  }
  Event head = event(kind, time);
  if (!has_room(1 + (text.size() + sizeof(Event) - 1) / sizeof(Event))) return;
  head.subject = static_cast<std::uint32_t>(text.size());
  head.version = level;
  push(head);
  push_bytes(text.data(), text.size());
  publish();
}

void RecordingLane::call(Time time, std::uint32_t behaviour, std::uint64_t iteration) {
  if (tally_ != nullptr) return;
  Event begun = event(Event::Kind::call, time);
  if (!has_room(1)) return;
  begun.subject = behaviour;
  begun.version = static_cast<std::uint32_t>(iteration);
  push(begun);
  publish();
}

void RecordingLane::poses(Time time, std::string_view frame) {
  sequence_ = 0;  // frames have numbers of their own
  text(Event::Kind::poses, time, 0, frame);
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

/// Pushes the bytes in pieces of the size of an event; the last piece is padded.
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

std::unique_ptr<Recorder> Recorder::open(const std::string& path, const RecordingHeader& header,
                                         std::uint32_t instances, Mode mode, std::string& error,
                                         std::size_t longest, RunOptions::Limit limit,
                                         std::unique_ptr<MarkingTrack> track,
                                         std::span<const std::uint32_t> numbers) {
  std::unique_ptr<Recorder> recorder(new Recorder);
  if (!recorder->file_.open(path, header, error, limit, std::move(track))) return nullptr;
  // About 24 MB of rings. Each can hold up to a quarter of a second at a million events per second.
  const std::size_t least = std::max<std::size_t>(512, 8 * longest / sizeof(Event));
  const std::size_t capacity =
      mode == Mode::direct
          ? 0
          : std::max(least, std::min((std::size_t{1} << 20) / (instances + 1), std::size_t{1} << 18));
  for (std::uint32_t instance = 0; instance < instances; ++instance)
    recorder->lanes_.push_back(std::make_unique<RecordingLane>(numbers.empty() ? instance : numbers[instance],
                                                               recorder->file_, capacity));
  const std::size_t of_world = header.has_scene ? capacity : 0;
  recorder->lanes_.push_back(std::make_unique<RecordingLane>(system_instance, recorder->file_, of_world));
  recorder->lanes_.push_back(std::make_unique<RecordingLane>(system_instance, recorder->file_, capacity));
  if (mode == Mode::threaded)
    recorder->writer_ = std::thread([raw = recorder.get()] { raw->write_until_closed(); });
  return recorder;
}

std::unique_ptr<Recorder> Recorder::counting(std::uint32_t instances, RunTally& tally) {
  std::unique_ptr<Recorder> recorder(new Recorder);
  recorder->is_written_ = false;
  for (std::uint32_t instance = 0; instance < instances; ++instance)
    recorder->lanes_.push_back(std::make_unique<RecordingLane>(instance, recorder->file_, 0, &tally));
  recorder->lanes_.push_back(std::make_unique<RecordingLane>(system_instance, recorder->file_, 0, &tally));
  return recorder;
}

Recorder::~Recorder() {
  if (writer_.joinable()) static_cast<void>(close());
}

void Recorder::write_until_closed() {
  WakeWord never;  // only its timeout ends the wait, so that producers never have to wake the writer
  try {
    while (closing_.load(std::memory_order_acquire) == 0) {
      drain();
      file_.flush();
      never.sleep(never.ticket(), monotonic_ns() + drain_period_ns);
    }
  } catch (const std::exception& exception) {  // no memory: events that come now are lost, and counted
    file_.fail(exception.what());
  }
}

void Recorder::drain() {
  if (file_.track() != nullptr) return drain_in_order();
  for (const auto& lane : lanes_) lane->drain();
}

/// Segments can be checked on their own because every firing comes after those on which it depends. A firing
/// waits for those as long as the threads need, however busy the machine is. Only if one of them is lost, or
/// events will soon be lost, are the rest written in the order of arrival.
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
  if (!is_written_) return {};
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
  if (file_.failure()) {  // also an error of closing
    lost = file_.lost();
    for (const auto& lane : lanes_) lost += lane->lost();
  }
  return {.lost = lost, .failure = file_.failure(), .kept_from_ns = file_.kept_from_ns()};
}

}  // namespace tessera
