#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "net/net.hpp"
#include "replay/values.hpp"
#include "server/recordings/marking_tracker.hpp"
#include "server/recordings/recording_stream.hpp"
#include "tessera/recording.hpp"

namespace tessera::server {

/// What the elements of a net are numbered: recordings have names.
class NetNames {
 public:
  explicit NetNames(const net::Net& net);
  /// Per transition of the recording; UINT32_MAX: the net has no such transition.
  [[nodiscard]] std::vector<std::uint32_t> transitions_of(const Recording& recording) const;
  /// Places with a token, as an event `marking` lists them.
  [[nodiscard]] std::vector<std::uint32_t> marked(std::string_view lines) const;

 private:
  using Numbers = std::vector<std::pair<std::string_view, std::uint32_t>>;  // sorted
  template <class Elements>
  [[nodiscard]] static Numbers numbers_of(const Elements& elements);
  [[nodiscard]] static std::uint32_t find(const Numbers& numbers, std::string_view name);
  Numbers places_, transitions_;
};

/// Follows a run by its recording: what has fired, where the tokens are, and what the buffers hold.
class RecordingTail {
 public:
  /// net: must outlive it.
  RecordingTail(RecordingStream::Source source, const net::Net& net);

  static constexpr std::size_t most_firings = 2000, largest_value = 4096;
  struct Batch {
    std::int64_t time_ns = 0;   ///< of the last event
    std::uint64_t dropped = 0;  ///< firings that are not listed, before those that are
    std::vector<std::pair<std::int64_t, std::uint32_t>> firings;  ///< time, transition of the net
    bool jumped = false;  ///< the marking is what a segment began with, and not only what has fired
    bool more = false;    ///< there may be more already
  };
  /// What has been written since, as far as it can be read in a few milliseconds.
  [[nodiscard]] Batch next();
  /// Places with a token after all that `next` has read.
  [[nodiscard]] std::vector<std::uint32_t> marking() const { return tokens_.marked(); }
  /// {"robot.sensor.line": number, bool, text, list or object} of the buffers whose values have changed since
  /// they were last taken, about so many bytes of them; the others come next. Not of those that are not
  /// recorded whole, or larger than largest_value.
  [[nodiscard]] nlohmann::json take_changed_values(std::size_t most = SIZE_MAX);

 private:
  struct Segment {
    Segment(std::shared_ptr<const Recording> its_recording, const NetNames& names);
    std::shared_ptr<const Recording> recording;
    std::vector<std::uint32_t> transitions;  // of the recording: indices of the net
    replay::ValueTrack values;
    std::deque<std::uint32_t> changed;  // buffers
    std::vector<bool> has_changed;      // per buffer
  };
  void keep(Batch& batch, const Recording::Entry& entry);
  static void keep_the_last(Batch& batch);
  NetNames names_;
  RecordingStream stream_;
  std::optional<Segment> segment_;
  nlohmann::json values_ = nlohmann::json::object();  // of segments before, not taken yet
  MarkingTracker tokens_;
};

}  // namespace tessera::server
