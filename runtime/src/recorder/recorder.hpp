#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "recorder/marking_track.hpp"
#include "recorder/run_tally.hpp"
#include "tessera/controller.hpp"
#include "tessera/recording.hpp"
#include "tessera/result.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The beginning of a recording.
struct RecordingHeader {
  std::string json;
  bool has_scene = false;  ///< there may be poses
};

/// Writes the bytes of a recording. Errors are remembered, not thrown; after an error nothing is written.
///
/// Threads: one at a time.
class RecordingFile {
 public:
  /// track: from the start of the run; not nullptr if there is a limit. false and `error` if the file
  /// cannot be created, or if the limit is too small for the header. A pipe or a device has no limit: it keeps
  /// nothing, and must not be renamed.
  [[nodiscard]] bool open(const std::string& path, const RecordingHeader& header, std::string& error,
                          RunOptions::Limit limit = {}, std::unique_ptr<MarkingTrack> track = nullptr);
  RecordingFile() = default;
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;
  ~RecordingFile();

  void append(const Event& event);
  /// The order of later events is not known. So the marking at the start of a
  /// later segment is unknown, too.
  void forget_marking() {
    if (track_ != nullptr) track_->forget();
  }
  /// Writes the last event, which distinguishes a run that has ended from one that was cut off.
  /// lost: number of missing events.
  void put_end(std::uint64_t lost);
  void flush();
  void close();
  /// Stops writing.
  void fail(std::string_view why) { failure_ = Problem{std::string(why)}; }
  /// The run has ended: waits at most two more seconds for a pipe that is not read. Threads: any.
  void hurry() { hurry_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] const std::optional<Problem>& failure() const { return failure_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }  ///< events
  /// The time from which on events are left, if the limit has dropped the first ones.
  [[nodiscard]] std::optional<std::int64_t> kept_from_ns() const {
    return track_ == nullptr || segment_ < limit_.segments ? std::nullopt : std::optional(began_ns_.front());
  }
  /// nullptr: there is no limit.
  [[nodiscard]] const MarkingTrack* track() const { return track_.get(); }

 private:
  [[nodiscard]] bool has_room_for_segments(RunOptions::Limit limit, std::string& error);
  [[nodiscard]] bool take_file();
  [[nodiscard]] bool is_still_there();
  void begin_file();
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
  std::deque<std::int64_t> began_ns_;  // of the segments that are kept
  std::uint64_t pieces_left_ = 0;      // of the text of the last event
  std::int64_t last_ns_ = 0;           // time of the latest event
  int descriptor_ = -1;
  bool is_empty_ = false;  ///< the file, when it was opened
  std::array<Event, 2048> buffer_{};
  std::size_t filled_ = 0;
  std::uint64_t lost_ = 0;
  std::optional<Problem> failure_;
  std::atomic<bool> hurry_{false};
};

/// Passes the events of one thread to the file: directly, or through a ring to a thread that writes. If the
/// ring is full, the event is lost and counted; nothing ever waits.
///
/// Threads: the producer's; drain on the writer's.
class RecordingLane {
 public:
  /// capacity 0: events are appended directly.
  /// tally: counts the events, which are then not written; nullptr: none.
  RecordingLane(std::uint32_t instance, RecordingFile& file, std::size_t capacity, RunTally* tally = nullptr);

  void firing(Time time, std::uint32_t transition, std::uint32_t version);
  void overrun(Time time, std::uint32_t missed);
  void text(Event::Kind kind, Time time, std::uint32_t level, std::string_view text);
  void call(Time time, std::uint32_t behaviour, std::uint64_t iteration);
  /// A frame of tessera/poses.hpp. Only on the lane of the world.
  void poses(Time time, std::string_view frame);
  /// head: at most sizeof(Event) bytes that are written before the others.
  void value(Time time, std::uint32_t buffer, std::uint32_t flags, std::span<const std::byte> head,
             std::span<const std::byte> bytes);
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  /// Writes the content of the ring to the file. in_order: only up to a firing that depends on one that is
  /// not in the file yet. true: there was an event.
  bool drain(bool in_order = false);
  /// The state of the ring as the writer sees it.
  struct Backlog {
    bool waits = false;     ///< the ring is not empty
    bool is_high = false;   ///< the ring is so full that events will soon be lost
    bool has_lost = false;  ///< a firing has been lost for good
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
  RunTally* tally_;
  std::vector<Event> ring_;         // empty: events are appended directly; otherwise a power of two
  std::uint64_t pushed_ = 0;        // used by the producer only
  std::uint64_t seen_drained_ = 0;  // the value of drained_ that the producer saw last
  alignas(64) std::atomic<std::uint64_t> published_{0};
  std::atomic<bool> has_lost_firings_{false};
  alignas(64) std::atomic<std::uint64_t> drained_{0};
};

/// The recording of a run: a lane per instance, one for the world, and one for the upper layers.
class Recorder {
 public:
  enum class Mode : std::uint8_t { direct, threaded };
  /// nullptr and `error` if the file cannot be created. longest: length of the longest value in bytes.
  /// limit, track: as in RecordingFile::open. numbers: of the instances in the recording; empty: 0, 1, ...
  [[nodiscard]] static std::unique_ptr<Recorder> open(const std::string& path, const RecordingHeader& header,
                                                      std::uint32_t instances, Mode mode, std::string& error,
                                                      std::size_t longest = 0, RunOptions::Limit limit = {},
                                                      std::unique_ptr<MarkingTrack> track = nullptr,
                                                      std::span<const std::uint32_t> numbers = {});
  /// Writes no file, and only counts. The tally must live longer.
  [[nodiscard]] static std::unique_ptr<Recorder> counting(std::uint32_t instances, RunTally& tally);
  ~Recorder();

  [[nodiscard]] RecordingLane* lane(std::uint32_t instance) { return lanes_[instance].get(); }
  [[nodiscard]] RecordingLane* system_lane() { return lanes_.back().get(); }
  /// For poses only.
  [[nodiscard]] RecordingLane* world_lane() { return lanes_[lanes_.size() - 2].get(); }
  void flush() { file_.flush(); }  ///< direct mode only

  struct Result {
    std::uint64_t lost = 0;
    std::optional<Problem> failure;
    std::optional<std::int64_t> kept_from_ns;  ///< as in RecordingFile
  };
  /// Writes the remaining events. Only after the producers have ended.
  [[nodiscard]] Result close();

 private:
  Recorder() = default;
  void write_until_closed();
  void drain();
  void drain_in_order();
  [[nodiscard]] bool waits_for_what_is_lost() const;
  RecordingFile file_;
  bool is_written_ = true;
  std::vector<std::unique_ptr<RecordingLane>> lanes_;
  std::atomic<std::uint32_t> closing_{0};
  std::thread writer_;
};

}  // namespace tessera
