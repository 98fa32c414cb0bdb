#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "net/net.hpp"
#include "replay/coverage.hpp"
#include "replay/values.hpp"
#include "server/recordings/arrays.hpp"
#include "server/recordings/marking_tracker.hpp"
#include "server/recordings/notices.hpp"
#include "server/recordings/pose_track.hpp"
#include "server/recordings/recording_stream.hpp"
#include "tessera/recording.hpp"

namespace tessera::server {

/// Translates the names in recordings into the numbers of a net's elements.
class NetNames {
 public:
  explicit NetNames(const net::Net& net);
  /// For each transition of the recording, that of the net; none: the net has no such transition.
  [[nodiscard]] std::vector<net::TransitionId> transitions_of(const Recording& recording) const;
  /// The places with a token, as listed by an event `marking`.
  [[nodiscard]] std::vector<net::PlaceId> marked(std::string_view lines) const;

 private:
  template <class Id>
  using Ids = std::vector<std::pair<std::string_view, Id>>;  // sorted
  template <class Id, class Elements>
  [[nodiscard]] static Ids<Id> ids_of(const Elements& elements);
  template <class Id>
  [[nodiscard]] static Id find(const Ids<Id>& ids, std::string_view name);
  Ids<net::PlaceId> places_;
  Ids<net::TransitionId> transitions_;
};

/// The part of the net that a run has reached so far.
///
/// Threads: any.
class Reached {
 public:
  explicit Reached(const net::Net& net) : counts_(net) {}
  /// The header of a segment. The first one begins the run.
  void begin(const Recording& header);
  void add(const std::vector<net::TransitionId>& fired, const std::vector<net::PlaceId>& marked);
  void lack_events();
  /// {"behaviours", "places", "transitions", "conditions", "missing", ...} of docs/reference/studio.md.
  [[nodiscard]] nlohmann::json coverage(const net::HierarchicalNet& pages, const net::Net& net) const;

 private:
  mutable std::mutex mutex_;
  replay::FiringCounts counts_;
  std::uint64_t next_segment_ = 0;
};

/// Follows a run by its recording: the firings, the marking, and the values of the buffers.
class RecordingTail {
 public:
  /// net, reached: must outlive this object. reached: nullptr: not needed.
  RecordingTail(RecordingStream::Source source, const net::Net& net, Reached* reached = nullptr);

  static constexpr std::size_t most_firings = 2000, largest_value = 4096, most_notices = 500;
  static constexpr std::size_t most_arrivals = 2000;
  struct Arrived {
    std::string path;
    std::int64_t time_ns = 0, written_ns = 0;
    bool valid = true;
  };
  struct Batch {
    std::int64_t time_ns = 0;   ///< of the last event
    std::uint64_t dropped = 0;  ///< firings that are not listed; they came before the listed ones
    std::vector<std::pair<std::int64_t, std::uint32_t>> firings;  ///< time, transition of the net
    std::vector<replay::RobotPoint> path;                         ///< of the only robot (PoseTrack)
    /// when inputs got values of their senders: path, and what `arrivals` of docs/reference/studio.md has
    std::vector<Arrived> arrivals;
    std::uint64_t arrivals_dropped = 0;  ///< those that are not listed; they came before the listed ones
    /// path and value of parameters that were given to the run, or that it has taken since
    std::vector<std::pair<std::string, std::string>> parameters;
    bool lacks_parameters = false;  ///< it begins in a later segment: parameters taken before are unknown
    /// the marking is that with which a segment began, so it does not follow from the firings alone
    bool jumped = false;
    bool more = false;  ///< there may be more already
  };
  /// The entries since the last call, as far as they can be read in a few milliseconds.
  [[nodiscard]] Batch next();
  /// The places with a token after everything that `next` has read.
  [[nodiscard]] std::vector<std::uint32_t> marking() const { return tokens_.marked(); }
  [[nodiscard]] ArrayTrack& arrays() { return arrays_; }
  [[nodiscard]] PoseTrack& poses() { return poses_; }
  [[nodiscard]] Notices& notices() { return notices_; }
  /// Whether the end of the recording is missing so far.
  [[nodiscard]] bool is_cut() const { return stream_.is_cut(); }
  /// The hash of the recorded net; nullopt: no header has been read.
  [[nodiscard]] std::optional<std::string> net_hash() const {
    return segment_ ? std::optional(segment_->recording->net_hash) : std::nullopt;
  }
  /// {"robot.sensor.line": number, bool, text, list or object} for the buffers whose values have changed
  /// since they were last taken, about `most` bytes of them; the others come next time. Leaves out values
  /// that are not recorded completely, or are larger than largest_value. null: its device gives none any more.
  [[nodiscard]] nlohmann::json take_changed_values(std::size_t most = SIZE_MAX);

 private:
  struct Segment {
    Segment(std::shared_ptr<const Recording> its_recording, const NetNames& names);
    std::shared_ptr<const Recording> recording;
    std::vector<net::TransitionId> transitions;  // for each transition of the recording, that of the net
    replay::ValueTrack values;
    std::deque<std::uint32_t> changed;  // indices of buffers
    std::vector<bool> has_changed;      // per buffer
    std::vector<bool> lost;             // per buffer: the device gives no value
    std::vector<bool> invalid;          // per buffer: an input that holds no valid value
  };
  void keep(Batch& batch, const Recording::Entry& entry);
  void keep_value(Batch& batch, const Recording::Entry& entry);
  static void keep_the_last(Batch& batch);
  NetNames names_;
  RecordingStream stream_;
  std::optional<Segment> segment_;
  nlohmann::json values_ = nlohmann::json::object();  // from earlier segments, not taken yet
  MarkingTracker tokens_;
  PoseTrack poses_;
  ArrayTrack arrays_;
  Notices notices_{most_notices};
  Reached* reached_;
  std::vector<net::TransitionId> fired_;  // since the last report to reached_
  std::vector<net::PlaceId> marked_;
};

}  // namespace tessera::server
