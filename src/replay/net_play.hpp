#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "net/net.hpp"
#include "net/token_game.hpp"
#include "tessera/recording.hpp"
#include "tessera/result.hpp"

namespace tessera::replay {

/// The first name in the header of a recording that the net has not, or has elsewhere: a subsystem, a
/// behaviour, a channel, a transition or its subsystem, a buffer, the agent of a body. A verdict and its
/// texts speak of these names, so a recording with others is not one of this net, whatever its hash says.
/// nullopt: all of them are right.
///
/// A net without parts (of no specification) has transitions only. Recordings without roles name no channels.
///
/// Threads: pure. Linear.
[[nodiscard]] std::optional<Problem> header_mismatch(const Recording& recording, const net::Net& net);

/// The token game of a net, played with the firings of a recording: nothing of the runtime's own firing is
/// used. Transitions and places are matched by name.
///
/// Threads: one at a time.
class NetPlay {
 public:
  NetPlay(const Recording& recording, const net::Net& net);
  /// Why the recording does not belong to this net (header_mismatch); nullopt: it does. Otherwise nothing
  /// else may be called.
  [[nodiscard]] const std::optional<Problem>& mismatch() const { return mismatch_; }

  /// Why a firing cannot be the next.
  struct Obstacle {
    enum class Kind : std::uint8_t {
      no,       ///< nothing: it can
      never,    ///< whatever other subsystems do, and whichever of their events are missing
      version,  ///< version `due` of its channel comes first
      token     ///< it lacks a token that another subsystem or the upper layers give
    } kind = Kind::no;
    net::PlaceId place{};   ///< the place without a token
    std::uint32_t due = 0;  ///< the version that comes first
  };
  [[nodiscard]] Obstacle obstacle(const Event& firing) const;
  /// "2.500000 s: 'robot.control.follow.t1' fired, but 'robot.control.follow.in' holds no token".
  [[nodiscard]] std::string complaint(const Event& firing, const Obstacle& obstacle) const;

  /// Fires. Returns what is wrong afterwards, a second token in a place.
  /// Precondition: no obstacle.
  [[nodiscard]] std::optional<Problem> fire(const Event& firing);

  /// The tokens where a segment begins; nullopt and `wrong` when the event names a place that is not there.
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> read_marking(const Recording::Entry& entry,
                                                                       std::string& wrong);
  /// Continues from this marking. The versions of the channels are then unknown.
  void start_from(std::vector<std::uint32_t> marking);
  /// The first place that holds another number of tokens; none: they are the same.
  [[nodiscard]] net::PlaceId difference(const std::vector<std::uint32_t>& marking) const;

  [[nodiscard]] std::uint32_t channels() const { return static_cast<std::uint32_t>(versions_.size()); }
  /// The channel that a firing touches, or none.
  [[nodiscard]] net::ChannelId channel_of(const Event& firing) const { return channels_[firing.subject]; }
  [[nodiscard]] bool knows_version(net::ChannelId channel) const {
    return versions_[channel.value].is != Version::unknown;
  }
  /// The next firing of the channel carries this version, if none is missing.
  void guess_version(net::ChannelId channel, std::uint32_t version);
  /// No firing was missing: the guessed versions are right.
  void confirm_versions();

  [[nodiscard]] const std::vector<std::uint32_t>& marking() const { return marking_; }
  [[nodiscard]] std::uint64_t firings() const { return firings_; }
  [[nodiscard]] const std::string& place_name(net::PlaceId place) const { return net_[place].name; }

 private:
  void match_transitions();
  void find_makers();
  struct Version {
    std::uint32_t last = 0;
    enum : std::uint8_t { unknown, guessed, known } is = known;
    [[nodiscard]] std::uint32_t due() const { return last == UINT32_MAX ? 1 : last + 1; }
  };

  const Recording& recording_;
  const net::Net& net_;
  std::optional<Problem> mismatch_;
  net::Marking marking_;
  std::uint64_t firings_ = 0;
  std::vector<net::TransitionId> transitions_;  // per transition of the recording
  std::vector<net::ChannelId> channels_;        // per transition of the recording
  /// Per place: the instance of the recording that fills it; nullopt: none, or several.
  std::vector<std::optional<std::uint32_t>> makers_;
  std::vector<Version> versions_;                               // per channel
  std::unordered_map<std::string_view, std::uint32_t> places_;  // by name; empty: not needed yet
};

/// "2.500000 s".
[[nodiscard]] std::string seconds_text(std::int64_t time_ns);

/// `a` comes before `b`; versions and sequences begin again after the largest number.
[[nodiscard]] inline bool is_before(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::int32_t>(a - b) < 0;
}

}  // namespace tessera::replay
