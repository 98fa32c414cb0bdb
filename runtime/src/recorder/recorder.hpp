#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "recorder/marking_track.hpp"
#include "tessera/controller.hpp"
#include "tessera/recording.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// Where the bytes of a recording go. Errors are remembered, not thrown; after one nothing is written any
/// more.
///
/// Threads: one at a time.
class RecordingFile {
 public:
  /// track: from the start of the run; not nullptr if there is a limit. false and `error` when it cannot be
  /// created, or the limit is too small for the header.
  [[nodiscard]] bool open(const std::string& path, std::string_view header, std::string& error,
                          RunOptions::Limit limit = {}, std::unique_ptr<MarkingTrack> track = nullptr);
  RecordingFile() = default;
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;
  ~RecordingFile();

  void append(const Event& event);
  /// The order of what follows is not known: neither is the marking that a later segment begins with.
  void forget_marking() {
    if (track_ != nullptr) track_->forget();
  }
  /// The last event of all, which tells a run that has ended from one that was cut off. lost: events that
  /// are missing.
  void put_end(std::uint64_t lost);
  void flush();
  void close();
  /// Nothing is written any more.
  void fail(std::string_view why) { failure_ = why; }
  /// The run has ended: a pipe that nobody reads is waited for two seconds more. Threads: any.
  void hurry() { hurry_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] const std::string& failure() const { return failure_; }  ///< empty: all went well
  [[nodiscard]] std::uint64_t lost() const { return lost_; }             ///< events
  /// nullptr: there is no limit.
  [[nodiscard]] const MarkingTrack* track() const { return track_.get(); }

 private:
  [[nodiscard]] bool open_segment();
  void keep_track(const Event& event);
  void begin_segment(std::int64_t time_ns);
  void put(const Event& event);
  void put_end(std::uint64_t lost, bool goes_on);
  void write_all(const char* bytes, std::size_t count);
  void await_room(std::int64_t& stuck_ns);
  std::string path_, header_;
  RunOptions::Limit limit_;
  std::unique_ptr<MarkingTrack> track_;
  std::uint64_t segment_ = 0, segment_bytes_ = 0;
  std::uint64_t pieces_left_ = 0;  // of the text of the last event
  std::int64_t last_ns_ = 0;       // the latest event
  int descriptor_ = -1;
  std::array<Event, 2048> buffer_{};
  std::size_t filled_ = 0;
  std::uint64_t lost_ = 0;
  std::string failure_;
  std::atomic<bool> hurry_{false};
};

/// Events of one thread on their way to the file: appended at once, or through a ring to a thread that
/// writes. A full ring loses the event and counts it; nothing ever waits.
///
/// Threads: the producer's; drain on the writer's.
class RecordingLane {
 public:
  /// capacity 0: append at once.
  RecordingLane(std::uint32_t instance, RecordingFile& file, std::size_t capacity);

  void firing(Time time, std::uint32_t transition, std::uint32_t version);
  void overrun(Time time, std::uint32_t missed);
  void text(Event::Kind kind, Time time, std::uint32_t level, std::string_view text);
  void call(Time time, std::uint32_t behaviour, std::uint64_t iteration);
  /// head: at most sizeof(Event) bytes, before the others.
  void value(Time time, std::uint32_t buffer, std::uint32_t flags, std::span<const std::byte> head,
             std::span<const std::byte> bytes);
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  /// What is in the ring goes to the file; in_order: up to a firing that follows from one which is not there
  /// yet. true: there was something.
  bool drain(bool in_order = false);
  /// The writer's view of it.
  struct Backlog {
    bool waits = false;     ///< something is in the ring
    bool is_high = false;   ///< so much that events are soon lost
    bool has_lost = false;  ///< a firing, for ever
  };
  [[nodiscard]] Backlog backlog() const;

 private:
  [[nodiscard]] Event event(Event::Kind kind, Time time);
  [[nodiscard]] bool has_room(std::uint64_t count);
  void push(const Event& event);
  void push_bytes(const void* bytes, std::size_t count);
  void publish();

  std::uint32_t instance_;
  std::uint32_t sequence_ = 0;
  std::uint64_t lost_ = 0;
  RecordingFile& file_;
  std::vector<Event> ring_;         // empty: append at once; otherwise a power of two
  std::uint64_t pushed_ = 0;        // the producer's
  std::uint64_t seen_drained_ = 0;  // the producer's last look at drained_
  alignas(64) std::atomic<std::uint64_t> published_{0};
  std::atomic<bool> has_lost_firings_{false};
  alignas(64) std::atomic<std::uint64_t> drained_{0};
};

/// The recording of a run: a lane per instance and one for the upper layers.
class Recorder {
 public:
  enum class Mode : std::uint8_t { direct, threaded };
  /// nullptr and `error` when the file cannot be created.
  /// longest: bytes of the longest value. limit, track: as RecordingFile::open.
  [[nodiscard]] static std::unique_ptr<Recorder> open(const std::string& path, std::string_view header,
                                                      std::uint32_t instances, Mode mode, std::string& error,
                                                      std::size_t longest = 0, RunOptions::Limit limit = {},
                                                      std::unique_ptr<MarkingTrack> track = nullptr);
  ~Recorder();

  [[nodiscard]] RecordingLane* lane(std::uint32_t instance) { return lanes_[instance].get(); }
  [[nodiscard]] RecordingLane* system_lane() { return lanes_.back().get(); }
  void flush() { file_.flush(); }  ///< direct mode only

  struct Result {
    std::uint64_t lost = 0;
    std::string failure;
  };
  /// Writes what is left. Only after the producers have ended.
  [[nodiscard]] Result close();

 private:
  Recorder() = default;
  void write_until_closed();
  void drain();
  void drain_in_order();
  [[nodiscard]] bool waits_for_what_is_lost() const;
  RecordingFile file_;
  std::vector<std::unique_ptr<RecordingLane>> lanes_;
  std::atomic<std::uint32_t> closing_{0};
  std::thread writer_;
};

}  // namespace tessera
