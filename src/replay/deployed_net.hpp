#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "net/net.hpp"

namespace tessera::replay {

/// Which agents of a deployed system run in which process.
struct ProcessMap {
  Numbered<ProcessId, std::string> names;
  Numbered<net::AgentId, ProcessId> of_agents;
};

/// The effect of a firing on the sender or on the receiver of a channel between processes.
enum class ChannelEffect : std::uint8_t {
  none,
  begins_write,     ///< both sides are non-blocking: the sender uses its memory
  writes,           ///< the value is on the way
  is_acknowledged,  ///< the sender knows that its value was taken
  gives_up,         ///< the sender's time is up
  begins_read,
  ends_read,
  skips  ///< there was nothing to read
};

/// A deployed net, as the check of its recordings needs it.
///
/// Threads: const members from any thread. The net lives longer.
class DeployedNet {
 public:
  DeployedNet(const net::Net& net, const ProcessMap& processes);

  /// The tokens that a firing takes from and gives to the shared places of a channel: one bit per place.
  struct Move {
    std::uint32_t takes = 0, gives = 0;
    bool operator==(const Move&) const = default;
  };
  struct Channel {
    bool networked = false;
    net::SubsystemId sender{}, receiver{};
    ProcessId sending{}, receiving{};
    std::vector<net::PlaceId> places;  ///< networked: its shared places, a bit each
    std::vector<Move> medium;          ///< the moves that are not recorded
    std::vector<Move> sides;           ///< those of its sender and its receiver
    bool exchange = false;             ///< both sides are non-blocking
  };
  struct Transition {
    net::ChannelId channel{};  ///< whose memory it uses
    ChannelEffect effect = ChannelEffect::none;
    bool carries_number = false;  ///< its firing carries the number of a value, not the version of a word
    ProcessId process{};          ///< none: of the whole system, or of a medium
    /// For a channel between processes: its own move, and those of the transitions with the same effect on
    /// its subsystem, which cannot know which of them happened.
    std::vector<Move> moves;
  };

  [[nodiscard]] const net::Net& net() const { return net_; }
  [[nodiscard]] const Channel& operator[](net::ChannelId id) const { return channels_[id.value]; }
  [[nodiscard]] const Transition& operator[](net::TransitionId id) const { return transitions_[id.value]; }
  [[nodiscard]] std::size_t process_count() const { return process_count_; }
  [[nodiscard]] std::size_t channel_count() const { return channels_.size(); }
  /// The process that owns the tokens of a place; none: the system, or a channel between processes.
  [[nodiscard]] ProcessId process_of(net::PlaceId place) const { return process_of_places_[place.value]; }
  /// Is it a shared place of a channel between processes?
  [[nodiscard]] bool is_hidden(net::PlaceId place) const { return hidden_[place.value]; }
  /// Do only firings of this subsystem fill the place? none: only those of the layers above.
  [[nodiscard]] bool is_made_by(net::PlaceId place, net::SubsystemId subsystem) const {
    return makers_[place.value] == subsystem;
  }
  /// The transition that starts all agents.
  [[nodiscard]] net::TransitionId start() const { return start_; }

 private:
  void find_channels(const ProcessMap& processes);
  void find_transitions(const ProcessMap& processes);
  void join_groups();
  void find_owners(const ProcessMap& processes);
  [[nodiscard]] Move move_of(net::TransitionId id) const;
  [[nodiscard]] ChannelEffect effect_of(net::TransitionId id) const;

  const net::Net& net_;
  std::size_t process_count_;
  std::vector<Channel> channels_;
  std::vector<Transition> transitions_;
  std::vector<std::uint32_t> bits_;  // per place: its bit in its channel
  std::vector<ProcessId> process_of_places_;
  std::vector<bool> hidden_;  // per place
  /// Per place: the subsystem that alone fills it, or none for the layers above; nullopt: nobody, or several.
  std::vector<std::optional<net::SubsystemId>> makers_;
  net::TransitionId start_{};
};

}  // namespace tessera::replay
