#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "net/net.hpp"
#include "replay/deployed_net.hpp"
#include "tessera/recording.hpp"
#include "tessera/result.hpp"

namespace tessera::replay {

/// The first name in the header of a recording that the net has not, or has elsewhere: a subsystem, a
/// behaviour, a channel, a transition or its subsystem, a buffer, the agent of a body. A verdict and its
/// texts speak of these names, so a recording with others is not one of this net, whatever its hash says.
/// nullopt: all of them are right.
///
/// A net without parts (of no specification) has transitions only.
///
/// Threads: pure. Linear.
[[nodiscard]] std::optional<Problem> header_mismatch(const Recording& recording, const net::Net& net);

/// The content of one recording, in numbers of the net.
class Source {
 public:
  explicit Source(const Recording& recording) : recording_(recording) {}

  /// Why the recording does not belong to this net; nullopt: it does.
  [[nodiscard]] std::optional<Problem> match(
      const net::Net& net, const std::unordered_map<std::string_view, std::uint32_t>& transitions);
  [[nodiscard]] net::TransitionId transition(const Event& event) const { return transitions_[event.subject]; }
  /// "robot.control", "the upper layers".
  [[nodiscard]] std::string path_of(const Event& event) const;
  [[nodiscard]] const Recording& recording() const { return recording_; }

  /// "office: 2.500000 s: "; without a process "2.500000 s: ".
  [[nodiscard]] std::string place_of(const Event& event) const;
  /// The mistake in the sequence of its events: one is repeated, or some are missing.
  [[nodiscard]] std::string twice(const Event& event) const;
  [[nodiscard]] std::string missing(const Event& event) const;
  /// A firing that is recorded as one of another subsystem, or of another process; nullopt: it is not.
  [[nodiscard]] std::optional<Problem> stranger(const Event& event, const DeployedNet& net) const;

 private:
  const Recording& recording_;
  std::vector<net::TransitionId> transitions_;  // per transition of the recording
};

/// Does it have a number in the sequence of its subsystem?
[[nodiscard]] inline bool is_counted(const Event& event) {
  return event.kind() != Event::Kind::marking && event.kind() != Event::Kind::poses;
}
/// Is it the marking with which a segment begins, as far as the writer knew it?
[[nodiscard]] inline bool is_known_marking(const Event& event) {
  return event.kind() == Event::Kind::marking && event.version == 0;
}
/// `a` comes before `b`; versions and sequences begin again after the largest number.
[[nodiscard]] inline bool is_before(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::int32_t>(a - b) < 0;
}
/// The incarnation in the second line of the text of a peer or a process; nullopt: there is none.
[[nodiscard]] std::optional<std::uint64_t> incarnation_in(std::string_view text);
/// Does a check of legality look at it?
[[nodiscard]] inline bool is_played(const Event& event) {
  return event.kind() == Event::Kind::firing || event.kind() == Event::Kind::peer;
}

/// The processes that are not given: "office, cart[0] and 3 more processes"; empty: all are.
[[nodiscard]] std::string names_without(const ProcessMap& processes, const std::vector<bool>& given);
/// By their processes, and those of one process by their incarnations.
[[nodiscard]] std::vector<const Recording*> in_order(std::span<const Recording> recordings);

}  // namespace tessera::replay
